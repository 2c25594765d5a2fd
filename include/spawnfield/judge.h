#pragma once

#include <spawnfield/export.h>
#include <spawnfield/collision.h>
#include <spawnfield/map.h>
#include <spawnfield/settled_pose.h>

#include <atomic>
#include <memory>
#include <optional>
#include <span>

namespace spawnfield {

/// Time that all threads together spent in exact collision checks.
struct ExactTime {
    std::atomic<std::int64_t> nanoseconds{0};
};

/// What the robot must not touch.
enum class Obstacles : std::uint8_t {
    Geometry,  ///< the scene's own geometry; collisions are exact
    Voxels     ///< the occupied voxels of the map's OctoMap
};

/// The limits and methods by which a Judge decides.
struct JudgeOptions {
    /// Greatest height of the robot's origin above its ground, m, inclusive, >= 0. Rasters of level poses with two
    /// dimensions do not use it, because their poses stand on the ground by definition.
    double max_height = 1.0;
    /// m, >= 0. Water that stands higher than this above the ground does not count.
    double max_water_depth = std::numeric_limits<double>::infinity();
    /// Steepest ground on which the robot may stand: rad from level, inclusive, > 0 and < pi/2. Infinite: slopes are
    /// not examined. With a limit, a pose that would be valid is also judged by the surfaces under the robot's
    /// contacts, and may be `steep` or `unstable`.
    ///
    /// The robot's own contacts are used if it has at least three that do not lie on one line. Otherwise, the contacts
    /// are the corners of the convex hull, seen from above, of all that lies within 2 cm of the robot's lowest point.
    /// They move with the pose, including its roll and pitch. If they then lie on one line (for example, a robot on its
    /// side), the pose is unstable. The surface under a contact is the top of the highest solid, terrain or obstacle,
    /// that begins no higher than the contact or the robot's lowest point. Solids that touch count as one. A surface is
    /// within reach if it is at most r tan(max_slope) + 2 cm above or below the pose's ground, where r is the contact's
    /// horizontal distance from the origin. If all surfaces are within reach, the pose is steep when the plane that
    /// fits them best (least squares) is steeper than max_slope, and otherwise valid. If a surface is out of reach, the
    /// pose is unstable. Exception: the pose is steep if that plane is too steep, and if the surfaces and the ground
    /// lie at most 2 cm + 10 % of the range of their heights from it (an even slope). So a larger max_slope never makes
    /// a valid pose invalid. Ground between the contacts is not examined.
    double max_slope = std::numeric_limits<double>::infinity();
    StandLimits stand = {};  ///< of settled poses; they do not use max_slope
    Obstacles obstacles = Obstacles::Geometry;
    bool exhaustive = false;  ///< FCL decides every collision, without mask and axis test: same answers, but slower
    ExactTime* exact_time = nullptr;  ///< if given, the time of exact checks is added to it
};

/// The verdict on one pose with its reasons.
struct Judgement {
    Verdict verdict = Verdict::Outside;
    std::optional<Ground> ground;     ///< poses outside the bounds may have one too
    std::optional<CollisionHit> hit;  ///< what the robot collides with; only from Judge::check
    bool exact_check = false;         ///< whether an exact collision check was made
};

/// How a long call runs. Results are the same for any number of threads.
struct RunOptions {
    int threads = 0;  ///< 0: all cores
    Progress progress = {};
};

/// Decides where a robot can stand in a map. Cheap to copy: copies share their parts.
///
/// Create one for each combination of map, robot and options. It contains what queries prepare: the collision checker
/// and the free-space mask. Any number of threads may call its const methods at the same time. Those methods read the
/// map's tiles when they first need them, so they throw FileError if a tile of a map is damaged.
class SPAWNFIELD_API Judge {
public:
    /// Throws ArgumentError for options beyond their limits and for a robot without parts. Throws FileError if the
    /// map's OctoMap is needed and cannot be read.
    Judge(Map map, Robot robot, const JudgeOptions& options = {});

    /// Returns the verdict on a pose, with its ground and the part that the robot collides with.
    ///
    /// A pose that is aerial, off_terrain or submerged is judged again with the highest surface at or below the robot's
    /// lowest point on the vertical line through its origin, for example a crest between its wheels. If it is then
    /// Valid, it is Valid with that ground, which is above its origin.
    Judgement check(const Pose& scene_from_robot) const;
    /// Returns the judgement of each pose, in their order. Throws what options.progress throws.
    std::vector<Judgement> check(std::span<const Pose> poses, const RunOptions& options = {}) const;
    /// Returns whether the verdict is Valid, for example for planners. If the robot collides, this is faster than
    /// check(): the mask can prove a collision, but not with which part.
    bool is_valid(const Pose& scene_from_robot) const;

    /// Lets the robot down at a place with a yaw (rad), onto the ground at or below place.z (m), and returns how it
    /// comes to rest there. The first verdicts are those of a pose at the place: `outside`, `aerial`, `off_terrain`,
    /// `submerged`. See docs/standing.md. Throws ArgumentError if JudgeOptions::obstacles is Voxels.
    SettledPose settle(const Vec3& place, double yaw) const;
    /// The same for each pose, in their order. Only yaws are used for the robot at rest. If a pose is not valid, ground
    /// between its origin and the robot's lowest point above that is tried, too: the robot may stand over a crest. That
    /// pose counts if it is valid and not above the given one. Throws what options.progress throws.
    std::vector<SettledPose> settle(std::span<const Pose> poses, const RunOptions& options = {}) const;

    /// Returns the verdict and its cause in words, for example "collision with thin_wall". `judgement` must be that of
    /// the pose.
    std::string describe(const Pose& pose, const Judgement& judgement) const;
    std::string describe(const SettledPose& pose) const;

    const Map& map() const;
    const Robot& robot() const;
    const JudgeOptions& options() const;

    struct Impl;
    const Impl& impl() const { return *impl_; }

private:
    std::shared_ptr<const Impl> impl_;
};

/// Returns the part of a settled pose that poses as given have, too.
SPAWNFIELD_API Judgement judgement_of(const SettledPose& pose);

/// Returns the name of the part of the scene that was hit, or "occupancy" for voxels.
SPAWNFIELD_API std::string name_of(const CollisionHit& hit, const Map& map);

/// Returns the offset that puts the robot's lowest point 0.1 m above its layer, m.
SPAWNFIELD_API double auto_offset(const Robot& robot);

/// Returns 0.2 % of the robot's longer side, seen from above, m: for example 2 mm for a robot of 1 m. In a comparison
/// with a physics engine, robots with a larger margin stayed where they were (docs/standing.md).
SPAWNFIELD_API double auto_min_stability(const Robot& robot);

/// Returns whether a robot with this offset collides with all flat ground, because its lowest point is not above its
/// layer.
SPAWNFIELD_API bool is_in_flat_ground(const Robot& robot, double offset);

}  // namespace spawnfield
