#pragma once

#include <spawnfield/scene.h>

#include <vector>

namespace spawnfield {

/// A pose of a part on its path.
struct TimedPose {
    double time;  ///< s
    Pose pose;    ///< scene_from_part
};

/// The poses of a part, at ascending times. Between two of them, the part's origin moves straight at a constant speed,
/// and the part turns at a constant rate about one axis, the shorter way round. Before the first and after the last
/// pose, the part stands still.
using TimedPath = std::vector<TimedPose>;

/// Appends the space that a part sweeps in a window of time, as pieces and primitives of `part`. The part itself has
/// the pose identity.
///
/// A part that does not turn sweeps exactly this space: a box the convex hull of its two end positions, a sphere a
/// capsule. Cylinders, and the straight parts of capsules, count as prisms of 64 sides around them. A turn is divided
/// into steps. In each step a point at distance r from the part's origin leaves its chord by at most r angle^2 / 8, so
/// the hull of the two end positions, grown by that, contains the swept space. Steps are so small that it is at most
/// most_growth.
void append_swept(Scene& scene, std::uint32_t part, const Shape& shape, const TimedPath& path,
                  const TimeWindow& window);

/// The same for the mesh of a scene that has nothing else: each triangle sweeps a hull, and filled pieces are also
/// filled at the first pose.
void append_swept(Scene& scene, std::uint32_t part, const Scene& mesh, const TimedPath& path, const TimeWindow& window);

/// Returns whether the two poses differ by half a turn (to 1e-6 rad), so that neither way round is shorter.
bool is_half_turn(const Pose& a, const Pose& b);

inline constexpr double most_growth = 0.005;  ///< m; at corners of a hull sqrt(3) times as much

}  // namespace spawnfield
