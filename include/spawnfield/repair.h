#pragma once

#include <spawnfield/export.h>
#include <spawnfield/query.h>

#include <optional>
#include <span>
#include <vector>

namespace spawnfield {

/// Largest ratio of a repair's radius and the step of its grid, which then has 3 million columns.
inline constexpr double largest_repair_grid = 1000;

/// Which poses are tried as the repair of a pose: the *grid poses*.
///
/// They are on a grid of columns around the pose: x + i step, y + j step for all integers i and j, as far as
/// `radius`. Each terrain layer of a column within the map's z limits counts. Settled: the robot is let down onto the
/// layer, and the grid pose is its settled pose, raised by StandLimits::lift. Level: the robot keeps its roll and
/// pitch, and there are grid poses at two heights of its origin above the layer: that of the pose above its own ground
/// (if it has ground at most JudgeOptions::max_height below it), and that at which its lowest point is 0.1 m above the
/// layer. Grid poses that are farther than `radius` from the pose, in 3D, do not count.
struct RepairOptions {
    double radius = 1;  ///< m, > 0; lengths are compared to 1e-9 m
    /// Distance between the columns of the grid, m, at least radius / largest_repair_grid. No value:
    /// auto_repair_step().
    std::optional<double> step = {};
    /// Number of yaws, 1 .. 64. First, all grid poses have the yaw of the pose. Only if none of them is valid, they
    /// have the other yaws: those that differ from it by multiples of 2 pi / headings.
    int headings = 16;
    /// How the robot stands. It must be that with which the poses were judged. Settled needs JudgeOptions::obstacles
    /// Geometry.
    Stance stance = Stance::Level;
    int threads = 0;  ///< 0: all cores; results are the same for any number
    Progress progress = {};
};

/// The valid pose that replaces another one.
struct Repair {
    /// Nothing: no grid pose is valid. This is a proof for these grid poses, but not for poses between them.
    std::optional<Spawn> pose;
    double distance = 0;      ///< m, between the origins, in 3D
    double turn = 0;          ///< by which its yaw differs, rad, in (-pi, pi]; 0: the yaw is the same
    std::uint64_t tried = 0;  ///< number of grid poses that were judged; settled: how often the robot was let down
    std::uint64_t exact_checks = 0;  ///< at grid poses
};

/// Returns the valid grid pose that is nearest to a pose, for example to one that a change of the world has broken.
///
/// Valid grid poses of the pose's own yaw come first. Of the others, the nearest one is returned; of equally near ones
/// (to 1e-9 m), the one with the smallest turn, and of these the first one: near columns come first, equally near ones
/// in the order of j and then of i, and layers from the top down. Level poses are valid if Judge::check() says so,
/// settled ones if Judge::settle() does.
///
/// Takes up to (number of columns) x (layers) x (headings) judgements, for level poses twice as many, if nothing is
/// valid. Throws ArgumentError for options beyond their limits, and for a pose that is not finite. Throws FileError for
/// a damaged map.
SPAWNFIELD_API Repair nearest_valid(const Judge& judge, const Pose& pose, const RepairOptions& options = {});

/// The repairs of a list of poses.
struct RepairList {
    RepairOptions options;                       ///< those with which it was made; `step` has a value
    std::vector<std::optional<Repair>> repairs;  ///< one for each pose; nothing: the pose was valid
    std::size_t repaired = 0;                    ///< number of poses that have a valid grid pose
    std::size_t turned = 0;                      ///< those among them that have another yaw
    std::size_t unrepaired = 0;                  ///< number of poses without a valid grid pose
};

/// Calls nearest_valid() for each pose that is not valid. `judgements` has one for each pose, from Judge::check() or,
/// of settled poses, from judgement_of(). Throws what nearest_valid() and options.progress throw.
SPAWNFIELD_API RepairList repair_poses(const Judge& judge, std::span<const Pose> poses,
                                       std::span<const Judgement> judgements, const RepairOptions& options = {});

/// Returns the default step of the grid, m: a twentieth of the radius, or a quarter of the robot's shorter side, seen
/// from above, if that is less; but at least radius / 50.
SPAWNFIELD_API double auto_repair_step(const Robot& robot, double radius);

}  // namespace spawnfield
