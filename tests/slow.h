#pragma once

#include <spawnfield/robot.h>
#include <spawnfield/scene.h>

#include <optional>
#include <vector>

/// A second decision on poses, from DESIGN.md's definitions alone: every triangle, every primitive, no index, no FCL,
/// and nothing of the library but its plain data. Whatever lies too near to a limit to call is said to be so.
namespace slow {

/// Does the robot, grown by `grow` m on all sides (negative: shrunk), touch, overlap or lie inside solid space?
///
/// Cylinders become prisms: inscribed ones where grow < 0, circumscribed ones otherwise. So `true` for a shrunk robot
/// holds for the true one, and so does `false` for a grown one. Shrunk means: still touching after any shift by -grow.
bool collides(const spawnfield::Scene& scene, const spawnfield::Robot& robot, const spawnfield::Pose& scene_from_robot,
              double grow);

enum class Answer { No, Yes, TooClose };

/// collides, for a robot shrunk and grown by margin: TooClose where the two differ.
Answer collision(const spawnfield::Scene& scene, const spawnfield::Robot& robot,
                 const spawnfield::Pose& scene_from_robot, double margin = 1e-3);

/// Where a vertical line runs through one solid piece or primitive, or crosses a sheet (bottom == top).
struct Span {
    double bottom = 0, top = 0;
    bool terrain = false;   ///< a robot may stand on its top
    std::size_t owner = 0;  ///< piece, or pieces + primitive
};

struct Column {
    std::vector<Span> spans;    ///< of terrain and obstacles, piece after piece, then primitives
    std::vector<double> water;  ///< surfaces, in no order
};

/// What stands on the vertical line through (x, y). On a silhouette it may be either side's.
Column column(const spawnfield::Scene& scene, double x, double y);

/// Upper ends of the joined terrain, from the top down.
std::vector<double> layers(const spawnfield::Scene& scene, double x, double y);

struct Decision {
    std::optional<spawnfield::Verdict> verdict;  ///< nothing: another within margin, or the ground another piece's
    std::optional<double> ground;                ///< z, m; nothing: no ground
};

/// The verdict table, judged at the pose and at its neighbours at distance margin.
Decision decide(const spawnfield::Scene& scene, const spawnfield::Bounds& map_bounds, const spawnfield::Robot& robot,
                const spawnfield::Pose& scene_from_robot, double max_height, double max_water_depth,
                double margin = 1e-3);

/// How a robot with these contacts would stand at a pose over ground of this height, as QueryOptions::max_slope tells:
/// Valid, Steep or Unstable. Nothing where margin (m, and relative) more or less of anything gives another.
std::optional<spawnfield::Verdict> footing(const spawnfield::Scene& scene, const spawnfield::Robot& robot,
                                           const std::vector<spawnfield::Vec3>& contacts,
                                           const spawnfield::Pose& scene_from_robot, double ground, double max_slope,
                                           double margin = 1e-3);

}  // namespace slow
