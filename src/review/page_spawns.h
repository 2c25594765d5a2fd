#pragma once

#include "poses/pose_json.h"

#include <spawnfield/review.h>

namespace spawnfield {

/// Return the objects of docs/review-format.md for a list of poses, and for a list of pairs. `graph` must keep its
/// ways.
Json spawns_for_page(const Judge& judge, const ReviewSpawns& spawns, const ReviewContents& contents,
                     const RunOptions& options);
Json pairs_for_page(const Judge& judge, const ReachGraph& graph, const ReviewPairs& pairs, const RunOptions& options);

}  // namespace spawnfield
