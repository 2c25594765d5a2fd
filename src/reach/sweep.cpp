#include "reach/sweep.h"

#include "base/module.h"
#include "collision/narrow_phase_module.h"
#include "geometry/geometry_impl.h"
#include "settle/element_body.h"

#include <algorithm>

namespace spawnfield {
namespace {

/// A body as libccd sees it.
class OneBody : public narrow_phase_module::SupportMap {
public:
    explicit OneBody(const Convex& body) : body_(body) {}
    Vec3 support(const Vec3& direction) const override { return body_.support(direction); }

private:
    const Convex& body_;
};

/// The hull of several bodies, enlarged.
class GrownHull : public narrow_phase_module::SupportMap {
public:
    GrownHull(std::span<const Convex> bodies, double growth) : bodies_(bodies), growth_(touch_margin + growth) {}

    Vec3 support(const Vec3& direction) const override
    {
        return farthest(direction) + growth_ * direction.normalized();
    }

    /// Returns how far the hull reaches in a direction of length 1, m.
    double reach(const Vec3& direction) const { return farthest(direction).dot(direction) + growth_; }

    Vec3 farthest(const Vec3& direction) const
    {
        Vec3 out = bodies_.front().support(direction);
        for (const Convex& body : bodies_.subspan(1))
            if (const Vec3 point = body.support(direction); point.dot(direction) > out.dot(direction)) out = point;
        return out;
    }

    /// Returns whether a plane of a body is between it and the hull.
    bool is_beyond_plane(const Convex& body) const
    {
        return std::any_of(body.planes.begin(), body.planes.end(),
                           [&](const Convex::Plane& plane) { return -reach(-plane.normal) > plane.offset; });
    }

    Bounds bounds() const
    {
        Bounds out;
        for (const Convex& body : bodies_) {
            const Bounds box = body.bounds();
            out.extend(box.min - Vec3::Constant(growth_));
            out.extend(box.max + Vec3::Constant(growth_));
        }
        return out;
    }

private:
    std::span<const Convex> bodies_;
    double growth_;
};

}  // namespace

Sweep::Sweep(const Geometry& geometry, const Robot& robot)
    : geometry_(geometry), narrow_phase_(module_functions<narrow_phase_module::Functions>())
{
    for (const RobotPart& part : robot.parts) parts_.push_back(convex_of(part));
}

void Sweep::set_place(const Vec2& place, double radius)
{
    origin_ = {place.x(), place.y(), 0};
    solids_.clear();
    geometry_.impl().visit_in({place.x() - radius, place.y() - radius, place.x() + radius, place.y() + radius},
                              [&](const Tile& tile, auto element) {
                                  if (tile.label(element) == Label::Water || tile.label(element) == Label::Ignore)
                                      return;
                                  Solid& solid = solids_.emplace_back();
                                  solid.body = body_of(tile, element, origin_);
                                  solid.bounds = solid.body.bounds();
                              });
}

bool Sweep::is_free(std::span<const Pose> poses, double lift, double growth)
{
    placed_.clear();
    for (std::size_t p = 0; p < parts_.size(); ++p)
        for (const Pose& pose : poses)
            placed_.push_back(moved(parts_[p], {pose.position - origin_ + lift * Vec3::UnitZ(), pose.rotation}));
    if (!may_meet(placed_, growth)) return true;
    for (std::size_t p = 0; p < parts_.size(); ++p)
        for (std::size_t k = 0; k + 1 < poses.size(); ++k)
            if (is_met(std::span(placed_).subspan(p * poses.size() + k, 2), growth)) return false;
    return true;
}

/// Returns whether the hull of these bodies may meet something, and sets near_ to that. Nearly always, it is apart from
/// all solids by their bounds, or by one of their planes.
bool Sweep::may_meet(std::span<const Convex> bodies, double growth)
{
    const GrownHull hull(bodies, growth);
    const Bounds box = hull.bounds();
    near_.clear();
    for (const Solid& solid : solids_)
        if (solid.bounds.meets(box) && !hull.is_beyond_plane(solid.body)) near_.push_back(&solid);
    return !near_.empty();
}

/// Returns whether the hull of these bodies meets one of near_.
bool Sweep::is_met(std::span<const Convex> bodies, double growth) const
{
    const GrownHull hull(bodies, growth);
    const Bounds box = hull.bounds();
    return std::any_of(near_.begin(), near_.end(), [&](const Solid* solid) {
        return solid->bounds.meets(box) && !hull.is_beyond_plane(solid->body) &&
               narrow_phase_.bodies_meet(hull, OneBody(solid->body));
    });
}

}  // namespace spawnfield
