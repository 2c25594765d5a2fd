#include "query/place_meter.h"

#include "geometry/geometry_impl.h"
#include "query/sight.h"
#include "settle/element_body.h"
#include "settle/touch.h"

#include <spawnfield/column.h>
#include <spawnfield/error.h>
#include <spawnfield/heading_rule.h>

#include <Eigen/QR>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace spawnfield {
namespace {

constexpr double most_head_room = 10;  // m: more is not measured
constexpr int rough_points = 9;        // along each side of the rectangle around the robot
constexpr int view_directions = 64;

bool is_of_settled(PlaceQuantity quantity)
{
    return quantity == PlaceQuantity::Tilt || quantity == PlaceQuantity::Margin || quantity == PlaceQuantity::Room;
}

void check_quantity(const char* function, PlaceQuantity quantity, bool is_settled)
{
    if (is_of_settled(quantity) && !is_settled)
        throw ArgumentError(function, std::string("the quantity ") + to_string(quantity) +
                                          " is only known of settled robots; give stance Settled, or leave it out");
}

void check_measures(const char* function, const PlaceMeasures& measures, bool is_settled)
{
    for (auto at = measures.columns.begin(); at != measures.columns.end(); ++at) {
        check_quantity(function, *at, is_settled);
        if (std::find(measures.columns.begin(), at, *at) != at)
            throw ArgumentError(function, std::string("the column ") + to_string(*at) + " is given twice, needs once");
    }
    for (const PlaceMeasures::Preference& factor : measures.prefer) {
        check_quantity(function, factor.quantity, is_settled);
        if (factor.quantity == PlaceQuantity::Tilt || factor.quantity == PlaceQuantity::Roughness)
            throw ArgumentError(function,
                                std::string("prefer has ") + to_string(factor.quantity) +
                                    ", of which less is better; needs clearance, head_room, margin, view or room");
        if (!(factor.weight > 0) || !std::isfinite(factor.weight))
            throw ArgumentError(function, "prefer.weight", factor.weight, "> 0");
    }
    if (!(measures.view_range > 0) || !std::isfinite(measures.view_range))
        throw ArgumentError(function, "view_range", measures.view_range, "> 0 m");
    if (asks_for(measures, PlaceQuantity::Room)) {
        if (!measures.room)
            throw ArgumentError(function, "the quantity room needs measures.room, for example room_on(graph, range)");
        if (!(measures.room_range > 0 && measures.room_range <= PlaceMeasures::most_room_range))
            throw ArgumentError(function, "room_range", measures.room_range,
                                "> 0 and at most " + std::to_string(int(PlaceMeasures::most_room_range)) + " m");
    }
    if (measures.sensor_height && !std::isfinite(*measures.sensor_height))
        throw ArgumentError(function, "sensor_height", *measures.sensor_height, "a finite number, m");
}

}  // namespace

const char* to_string(PlaceQuantity quantity)
{
    switch (quantity) {
    case PlaceQuantity::Clearance: return "clearance";
    case PlaceQuantity::HeadRoom: return "head_room";
    case PlaceQuantity::Tilt: return "tilt";
    case PlaceQuantity::Margin: return "margin";
    case PlaceQuantity::Roughness: return "roughness";
    case PlaceQuantity::View: return "view";
    case PlaceQuantity::Room: return "room";
    }
    return "";
}

bool asks_for(const PlaceMeasures& measures, PlaceQuantity quantity)
{
    return std::find(measures.columns.begin(), measures.columns.end(), quantity) != measures.columns.end() ||
           std::any_of(measures.prefer.begin(), measures.prefer.end(),
                       [&](const auto& factor) { return factor.quantity == quantity; });
}

PlaceMeter::PlaceMeter(const char* function, const Geometry& geometry, const Robot& robot,
                       const PlaceMeasures& measures, bool is_settled)
    : geometry_(geometry), measures_(measures), clearances_(geometry, robot), box_(robot.bounds())
{
    check_measures(function, measures, is_settled);
    for (const RobotPart& part : robot.parts) bodies_.push_back(convex_of(part));
}

double PlaceMeter::measure(PlaceQuantity quantity, const Pose& pose, double tilt, double margin,
                           Neighbour* neighbour) const
{
    switch (quantity) {
    case PlaceQuantity::Clearance: return clearances_.clearance_at(pose, neighbour);
    case PlaceQuantity::HeadRoom: return head_room(pose);
    case PlaceQuantity::Tilt: return tilt;
    case PlaceQuantity::Margin: return margin;
    case PlaceQuantity::Roughness: return roughness(pose);
    case PlaceQuantity::View: return view(pose);
    case PlaceQuantity::Room: return measures_.room(pose);
    }
    return 0;
}

double PlaceMeter::preference(const Pose& pose, double margin) const
{
    double out = 1;
    for (const auto& [quantity, weight] : measures_.prefer) {
        const double share = measure(quantity, pose, 0, margin) / most_of(quantity);
        out *= std::pow(std::clamp(share, 0.0, 1.0), weight);
    }
    return out;
}

/// Returns an upper limit of a quantity that can be preferred.
double PlaceMeter::most_of(PlaceQuantity quantity) const
{
    switch (quantity) {
    case PlaceQuantity::Clearance: return ClearanceMeter::most;
    case PlaceQuantity::HeadRoom: return most_head_room;
    // The margin is at most the radius of a circle around all contacts, and these are parts of the robot.
    case PlaceQuantity::Margin: return (box_.max - box_.min).norm() / 2;
    case PlaceQuantity::Room: return std::numbers::pi * measures_.room_range * measures_.room_range;
    default: return 1;
    }
}

double PlaceMeter::head_room(const Pose& pose) const
{
    std::vector<Convex> bodies;
    Bounds all;
    for (const Convex& body : bodies_) {
        bodies.push_back(moved(body, {Vec3::Zero(), pose.rotation}));
        const Bounds box = bodies.back().bounds();
        all.extend(box.min);
        all.extend(box.max);
    }
    double out = most_head_room;
    const Bounds above{pose.position + all.min, pose.position + all.max + most_head_room * Vec3::UnitZ()};
    geometry_.impl().visit_tiles(above, [&](const Tile& tile, const ElementBox&) {
        for_each_bit(tile.near(above), [&](std::uint32_t element) {
            if (tile.label(element) == Label::Water) return;
            if (tile.bounds(element).min.z() - pose.position.z() - all.max.z() >= out) return;
            const Convex solid = body_of(tile, element, pose.position);
            for (const Convex& body : bodies)
                if (const std::optional<Interval> blocked = blocked_heights(body, solid); blocked && blocked->top > 0)
                    out = std::clamp(blocked->bottom, 0.0, out);
        });
    });
    return out;
}

double PlaceMeter::roughness(const Pose& pose) const
{
    const double middle = (pose.rotation * (box_.min + box_.max) / 2 + pose.position).z();
    std::vector<Vec3> points;
    for (int row = 0; row < rough_points; ++row)
        for (int col = 0; col < rough_points; ++col) {
            const Vec3 share(col / double(rough_points - 1), row / double(rough_points - 1), 0);
            const Vec3 at = pose.rotation * (box_.min + share.cwiseProduct(box_.max - box_.min)) + pose.position;
            const std::optional<Ground> ground = ground_below(column_at(geometry_, at.x(), at.y()), middle);
            if (ground)
                points.emplace_back(at.x() - pose.position.x(), at.y() - pose.position.y(),
                                    ground->height - pose.position.z());
        }
    if (points.size() < 4) return std::numeric_limits<double>::quiet_NaN();
    Eigen::MatrixX3d plane(points.size(), 3);
    Eigen::VectorXd heights(points.size());
    for (std::size_t k = 0; k < points.size(); ++k) {
        plane.row(Eigen::Index(k)) << points[k].x(), points[k].y(), 1;
        heights[Eigen::Index(k)] = points[k].z();
    }
    const Eigen::Vector3d fit = plane.colPivHouseholderQr().solve(heights);
    return (plane * fit - heights).norm() / std::sqrt(double(points.size()));
}

double PlaceMeter::view(const Pose& pose) const
{
    const Vec3 sensor = pose.position + measures_.sensor_height.value_or(box_.max.z()) * pose.rotation.col(2);
    int clear = 0;
    for (int k = 0; k < view_directions; ++k) {
        const double yaw = heading_of(k, view_directions);
        clear += is_clear_line(geometry_, sensor,
                               sensor + measures_.view_range * Vec3(std::cos(yaw), std::sin(yaw), 0));
    }
    return double(clear) / view_directions;
}

}  // namespace spawnfield
