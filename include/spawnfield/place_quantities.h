#pragma once

#include <spawnfield/export.h>
#include <spawnfield/types.h>

#include <array>
#include <functional>
#include <optional>
#include <string>
#include <vector>

namespace spawnfield {

/// How good a place is. All quantities are those of a pose as it is written. See docs/places.md.
enum class PlaceQuantity : std::uint8_t {
    Clearance,  ///< m, 0 .. 10: shortest horizontal shift with which the robot touches an obstacle
    HeadRoom,   ///< m, 0 .. 10: how far the robot can be raised straight up until it touches terrain or an obstacle
    Tilt,       ///< rad; only of settled robots, as in SettledPose
    Margin,     ///< m; only of settled robots, as in SettledPose
    /// m: root of the mean squared vertical distance of the ground from the plane that fits it best. The ground is
    /// taken at 9 x 9 points of the rectangle around the robot in its own frame: the highest surface that is not above
    /// the middle of the robot's height. Points without ground do not count; NaN with less than 4 points.
    Roughness,
    /// 0 .. 1: share of 64 horizontal directions in which nothing touches a line from the sensor to
    /// PlaceMeasures::view_range. The first direction is x, and water does not count.
    View,
    Room  ///< m2; only of settled robots: PlaceMeasures::room
};

/// All quantities, in the order of the enumeration.
inline constexpr std::array all_place_quantities{
    PlaceQuantity::Clearance, PlaceQuantity::HeadRoom, PlaceQuantity::Tilt, PlaceQuantity::Margin,
    PlaceQuantity::Roughness, PlaceQuantity::View,     PlaceQuantity::Room};

/// Returns the room to manoeuvre around a valid settled pose as it is written, m2, for example that of room_on().
using RoomMeter = std::function<double(const Pose&)>;

SPAWNFIELD_API const char* to_string(PlaceQuantity quantity);  ///< as in files: "head_room", …

/// A quantity of each spawn of a list.
struct PlaceColumn {
    PlaceQuantity quantity = PlaceQuantity::Clearance;
    std::vector<double> values;
};

/// What is measured of spawns, and which of them are preferred.
struct PlaceMeasures {
    std::vector<PlaceQuantity> columns = {};  ///< each at most once; SpawnList::columns has them

    /// A factor of the density of spawns: the quantity to the power of `weight`, > 0.
    struct Preference {
        PlaceQuantity quantity = PlaceQuantity::Clearance;  ///< Clearance, HeadRoom, Margin, View or Room
        double weight = 1;
    };
    /// The density of spawns by area is proportional to the product of these factors; empty: it is uniform.
    std::vector<Preference> prefer = {};
    double view_range = 10;  ///< m, > 0; for View
    /// Height of the sensor above the robot's origin, along the robot's z axis, m; no value: as high as the robot's
    /// highest point. For View and for the rules of sight.
    std::optional<double> sensor_height = {};
    static constexpr double most_room_range = 100;  ///< m
    /// m, > 0 .. most_room_range; for Room: that of `room`, for files and for the largest room that is possible.
    double room_range = 3;
    RoomMeter room = {};  ///< must be given for Room
};

/// Returns whether a column or a preference is this quantity.
SPAWNFIELD_API bool asks_for(const PlaceMeasures& measures, PlaceQuantity quantity);

}  // namespace spawnfield
