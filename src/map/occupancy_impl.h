#pragma once

#include <spawnfield/occupancy.h>

#include <octomap/OcTree.h>

namespace spawnfield {

struct OccupancyTree::Impl {
    std::shared_ptr<const octomap::OcTree> tree;
};

}  // namespace spawnfield
