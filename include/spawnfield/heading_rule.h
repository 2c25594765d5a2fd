#pragma once

#include <spawnfield/export.h>

#include <cstdint>
#include <numbers>
#include <optional>
#include <string>

namespace spawnfield {

/// How the yaw of a robot that is let down at a place is chosen.
struct HeadingRule {
    enum class Kind : std::uint8_t {
        Facing,    ///< towards (x, y)
        Downhill,  ///< in the direction in which the ground falls most; yaw 0 on level ground
        Uphill,    ///< the opposite direction
        All,       ///< the pose must be valid at each of `count` headings
        Any,       ///< the pose must be valid at one of them or more
        Best,      ///< the same; the heading is that with the largest margin
        Clearest,  ///< the same with the largest clearance: distance to obstacles (docs/standing.md)
        Along      ///< the same with the longest way straight ahead, for example along a corridor (docs/standing.md)
    };
    static constexpr int most = 64;        ///< headings: the bits of RasterRest::valid_headings
    static constexpr int most_steps = 40;  ///< for Along: half a robot's length each

    Kind kind = Kind::Any;
    double x = 0, y = 0;  ///< m; only for Facing
    int count = 8;        ///< 1 .. most; from All to Along: the headings are 2 pi k / count

    bool has_several() const { return kind >= Kind::All; }
};

/// Returns a rule as in --yaw: "facing:3,-1", "downhill", "any:8", "best:8:clearance", "along:16".
SPAWNFIELD_API std::string to_string(const HeadingRule& rule);

/// Returns how yaws are chosen, for people: the rule, or "random", or `yaw` (rad).
SPAWNFIELD_API std::string yaw_text(const std::optional<HeadingRule>& rule, bool is_random, double yaw);

/// Returns heading k of `count` headings, rad.
inline double heading_of(int k, int count) { return 2 * std::numbers::pi * k / count; }

}  // namespace spawnfield
