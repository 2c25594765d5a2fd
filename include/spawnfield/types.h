#pragma once

#include <spawnfield/export.h>

#include <Eigen/Core>

#include <array>
#include <cstdint>
#include <functional>
#include <limits>
#include <string>

/// All lengths are in metres and angles in radians. Frames are right-handed with x forward, y left, z up (REP-103).
namespace spawnfield {

using Vec3 = Eigen::Vector3d;
using Mat3 = Eigen::Matrix3d;

/// Indices of three vertices in a list.
using Triangle = std::array<std::uint32_t, 3>;

/// A closed range of heights, m; without limits by default.
struct ZRange {
    double low = -std::numeric_limits<double>::infinity();
    double high = std::numeric_limits<double>::infinity();

    bool is_unlimited() const { return *this == ZRange{}; }
    bool contains(double z, double tolerance) const { return z >= low - tolerance && z <= high + tolerance; }
    bool operator==(const ZRange&) const = default;
};

/// Returns the heights that are in both ranges. If there are none, the result has low > high and contains nothing.
inline ZRange overlap(const ZRange& a, const ZRange& b)
{
    return {a.low > b.low ? a.low : b.low, a.high < b.high ? a.high : b.high};
}

/// Axis-aligned box, including its surface. Empty while min > max.
struct Bounds {
    Vec3 min = Vec3::Constant(std::numeric_limits<double>::infinity());
    Vec3 max = Vec3::Constant(-std::numeric_limits<double>::infinity());

    bool is_empty() const { return !(min.array() <= max.array()).all(); }
    bool contains_xy(double x, double y, double tolerance) const
    {
        return x >= min.x() - tolerance && x <= max.x() + tolerance && y >= min.y() - tolerance &&
               y <= max.y() + tolerance;
    }
    /// Returns whether the boxes, including their surfaces, share a point. Only the first `axes` axes count.
    bool meets(const Bounds& other, int axes = 3) const
    {
        for (int axis = 0; axis < axes; ++axis)
            if (!(min[axis] <= other.max[axis] && max[axis] >= other.min[axis])) return false;
        return true;
    }
    ZRange z() const { return {min.z(), max.z()}; }
    void extend(const Vec3& point)
    {
        min = min.cwiseMin(point);
        max = max.cwiseMax(point);
    }
};

/// The place of a body in a parent frame: parent_point = rotation * body_point + position.
struct Pose {
    Vec3 position = Vec3::Zero();
    Mat3 rotation = Mat3::Identity();
};

/// Returns Rz(yaw) Ry(pitch) Rx(roll), the rotation for URDF's rpy.
SPAWNFIELD_API Mat3 rotation_from_rpy(double roll, double pitch, double yaw);

/// Returns outer_from_body for outer_from_inner and inner_from_body.
inline Pose operator*(const Pose& outer, const Pose& inner)
{
    return {outer.rotation * inner.position + outer.position, outer.rotation * inner.rotation};
}

/// The meaning of a surface for a robot.
enum class Label : std::uint8_t { Terrain, Obstacle, Water, Ignore };

/// The verdict on a pose. The numbers are those in files, so they never change.
enum class Verdict : std::uint8_t {
    Outside = 0,      ///< beyond the map's bounds in x and y, or beyond its z limits
    Aerial = 1,       ///< no ground below the origin, or more than JudgeOptions::max_height below it
    OffTerrain = 2,   ///< the ground is an obstacle, or the robot comes to rest on one
    Submerged = 3,    ///< the ground is under water, at most JudgeOptions::max_water_depth deep
    Collision = 4,    ///< the robot touches or overlaps something solid, or is inside it, or has no room to settle
    Steep = 5,        ///< the robot at rest, or the ground under its contacts, is too steep
    Unstable = 6,     ///< the robot tips over, or a contact hangs over an edge or stands against a wall
    Obstructed = 8,   ///< only settled poses: the robot cannot be raised off its rest, or cannot drop onto it
    Unreachable = 9,  ///< only settled poses: the query's ReachFilter refuses it
    Valid = 7         ///< none of the others applies
};
inline constexpr std::size_t verdict_count = 10;

/// All verdicts in the order of the definition: a pose has the first one that applies.
inline constexpr std::array<Verdict, verdict_count> all_verdicts{
    Verdict::Outside, Verdict::Aerial,   Verdict::OffTerrain, Verdict::Submerged,   Verdict::Collision,
    Verdict::Steep,   Verdict::Unstable, Verdict::Obstructed, Verdict::Unreachable, Verdict::Valid};

/// Number of poses for each verdict.
class VerdictCounts {
public:
    std::uint64_t operator[](Verdict verdict) const { return counts_[std::size_t(verdict)]; }
    std::uint64_t& operator[](Verdict verdict) { return counts_[std::size_t(verdict)]; }

    std::uint64_t total() const
    {
        std::uint64_t sum = 0;
        for (const std::uint64_t count : counts_) sum += count;
        return sum;
    }
    VerdictCounts& operator+=(const VerdictCounts& other)
    {
        for (const Verdict verdict : all_verdicts) (*this)[verdict] += other[verdict];
        return *this;
    }
    bool operator==(const VerdictCounts&) const = default;

private:
    std::array<std::uint64_t, verdict_count> counts_{};
};

/// Returns for example "0, 0, 0 to 1, 2, 3 m", rounded to nine digits. Only the first `axes` axes are included.
SPAWNFIELD_API std::string to_string(const Bounds& bounds, int axes = 3);
SPAWNFIELD_API const char* to_string(Label label);      ///< as in scene.yaml: "terrain", …
SPAWNFIELD_API const char* to_string(Verdict verdict);  ///< as in CSV files: "off_terrain", …

/// Called from time to time during long work, with the share that is done (0 .. 1). The calls may come from any thread,
/// but only one at a time. May throw to stop the work.
using Progress = std::function<void(double)>;
/// Is asked by several threads now and then. True: a query ends early, with what it has found. Once it has returned
/// true, it must always do so.
using StopRequest = std::function<bool()>;

SPAWNFIELD_API std::string version();  ///< "0.2.0"

}  // namespace spawnfield
