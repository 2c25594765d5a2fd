#include "placer.h"

#include "hand_scene.h"

#include <algorithm>

using namespace spawnfield;

namespace worlds {
namespace {

double distance(const Vec2& p, const Vec2& from, const Vec2& to)
{
    const Vec2 along = to - from;
    const double t = std::clamp((p - from).dot(along) / along.squaredNorm(), 0.0, 1.0);
    return (p - from - t * along).norm();
}

}  // namespace

void Placer::add(const std::string& kind, const Compound& compound, const Pose& pose)
{
    const std::string thing = kind + "-" + std::to_string(counts_[kind]++);
    for (const Element& element : compound) {
        Shape shape = element.shape;
        shape.pose = pose * shape.pose;
        hand::add_shape(scene_, Label::Obstacle, shape);
        scene_.parts.back().name = thing + "-" + element.name;
    }
}

void Placer::add(const std::string& kind, const Compound& compound, const Vec2& place, double yaw)
{
    add(kind, compound, {on_ground(place), rotation_from_rpy(0, 0, yaw)});
}

void Placer::keep_clear(const Vec2& from, const Vec2& to, double half_width)
{
    ways_.push_back({from, to, half_width});
}

bool Placer::is_clear(const Disc& ground) const
{
    const auto meets = [&](const Disc& other) {
        const double apart = ground.radius + other.radius;
        return (ground.centre - other.centre).squaredNorm() < apart * apart;
    };
    const auto crosses = [&](const Way& way) {
        return distance(ground.centre, way.from, way.to) < ground.radius + way.half_width;
    };
    return std::none_of(taken_.begin(), taken_.end(), meets) && std::none_of(ways_.begin(), ways_.end(), crosses);
}

}  // namespace worlds
