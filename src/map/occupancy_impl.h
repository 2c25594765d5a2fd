#pragma once

#include <spawnfield/occupancy.h>

#include <octomap/OcTree.h>

namespace spawnfield {

struct OccupancyTree::Impl {
    std::shared_ptr<const octomap::OcTree> tree;
    Vec3 origin = Vec3::Zero();  ///< where 0, 0, 0 of the tree is in the scene, m
};

}  // namespace spawnfield
