#pragma once

#include <spawnfield/robot.h>
#include <spawnfield/scene.h>

#include <optional>
#include <vector>

/// A second, independent decision on poses, written from the definitions in the documentation alone. It visits every
/// triangle and every primitive, without an index and without FCL, and uses only the plain data types of the library.
/// If something is too close to a limit, it gives no answer.
namespace slow {

/// Returns whether the robot, grown by `grow` m on all sides (negative: shrunk), touches, overlaps or lies inside solid
/// space.
///
/// Cylinders become prisms: inscribed ones if grow < 0, circumscribed ones otherwise. So `true` for a shrunk robot is
/// also right for the real one, and so is `false` for a grown one. Shrunk means: it still touches after any shift by
/// -grow.
bool collides(const spawnfield::Scene& scene, const spawnfield::Robot& robot, const spawnfield::Pose& scene_from_robot,
              double grow);

enum class Answer { No, Yes, TooClose };

/// Calls collides() for the robot shrunk and grown by margin. Returns TooClose if the two answers differ.
Answer collision(const spawnfield::Scene& scene, const spawnfield::Robot& robot,
                 const spawnfield::Pose& scene_from_robot, double margin = 1e-3);

/// The interval in which a vertical line runs through one solid piece or primitive, or the point at which it crosses a
/// sheet (bottom == top).
struct Span {
    double bottom = 0, top = 0;
    bool terrain = false;   ///< whether a robot may stand on its top
    std::size_t owner = 0;  ///< index of the piece; for a primitive its index plus the number of pieces
};

struct Column {
    std::vector<Span> spans;    ///< terrain and obstacles; first the pieces, then the primitives
    std::vector<double> water;  ///< heights of water surfaces, unsorted
};

/// Returns everything on the vertical line through (x, y). On a silhouette it may belong to either side.
Column column(const spawnfield::Scene& scene, double x, double y);

/// Returns the upper ends of the joined terrain, from the top down.
std::vector<double> layers(const spawnfield::Scene& scene, double x, double y);

struct Decision {
    /// No value if the verdict, or the piece of the ground, changes within margin.
    std::optional<spawnfield::Verdict> verdict;
    std::optional<double> ground;  ///< z, m; no value if there is no ground
};

/// Returns the verdict by the table of verdicts, if it is the same at the pose and at its neighbours at distance
/// margin.
Decision decide(const spawnfield::Scene& scene, const spawnfield::Bounds& map_bounds, const spawnfield::Robot& robot,
                const spawnfield::Pose& scene_from_robot, double max_height, double max_water_depth,
                double margin = 1e-3);

/// Returns how a robot with these contacts stands at a pose over ground of this height, by the rules of
/// JudgeOptions::max_slope: Valid, Steep or Unstable. Returns nothing if a change by margin (m, or relative) gives
/// another answer.
std::optional<spawnfield::Verdict> footing(const spawnfield::Scene& scene, const spawnfield::Robot& robot,
                                           const std::vector<spawnfield::Vec3>& contacts,
                                           const spawnfield::Pose& scene_from_robot, double ground, double max_slope,
                                           double margin = 1e-3);

}  // namespace slow
