#include "settle/near_solids.h"

#include "base/rounding.h"

#include <algorithm>
#include <cmath>

namespace spawnfield {
namespace {

constexpr double steepest_ground = 2;  // slope; steeper triangles may be walls, and what touches them is examined fully

bool is_ground(const std::optional<TouchTriangle>& triangle)
{
    return triangle && triangle->normal.head<2>().squaredNorm() <= steepest_ground * steepest_ground;
}

std::array<Vec3, 3> moved_by(const std::array<Vec3, 3>& corners, const Vec3& by)
{
    return {corners[0] + by, corners[1] + by, corners[2] + by};
}

/// An edge that two triangles share.
struct SharedEdge {
    int alone, other_alone;  ///< the corners of the first and the second triangle that are not on the edge

    /// Corner k of the first triangle is corner same[k] of the second one, -1: none. Exactly two are the same.
    explicit SharedEdge(const std::array<int, 3>& same)
        : alone(int(std::find(same.begin(), same.end(), -1) - same.begin())),
          other_alone(3 - same[std::size_t(alone + 1) % 3] - same[std::size_t(alone + 2) % 3])
    {
    }

    static std::uint8_t edge_without(int corner) { return std::uint8_t(1 << (corner + 1) % 3); }

    /// Returns a number that is negative if the triangles are on different sides of the edge, seen from above, m^4.
    double overhang(const TouchTriangle& first, const TouchTriangle& second) const
    {
        const Vec3 &shared = first.points[std::size_t(alone + 1) % 3], &own = first.points[std::size_t(alone)],
                   &other = second.points[std::size_t(other_alone)];
        const Vec2 edge = (first.points[std::size_t(alone + 2) % 3] - shared).head<2>();
        return cross(edge, (own - shared).head<2>()) * cross(edge, (other - shared).head<2>());
    }

    /// Returns how far the second triangle is above the plane of the first one, m; negative: the edge is a ridge.
    double rise(const TouchTriangle& first, const TouchTriangle& second) const
    {
        return first.normal.dot(second.points[std::size_t(other_alone)]) - first.height;
    }

    /// Returns whether nothing comes to lie on the edge that does not also lie on one of the triangles.
    bool is_valley(const TouchTriangle& first, const TouchTriangle& second) const
    {
        constexpr double flat = 1e-13;  // m
        return overhang(first, second) < 0 && !(rise(first, second) < -flat);
    }

    /// Returns whether is_valley() is the same at all places, and not a matter of rounding.
    bool is_clear(const TouchTriangle& first, const TouchTriangle& second) const
    {
        constexpr double clear = 1e-10;  // m or m^4
        return std::abs(overhang(first, second)) > clear && std::abs(rise(first, second)) > clear;
    }
};

}  // namespace

const std::vector<NearSolid>& NearSolids::at(const Vec3& place)
{
    if (place_ == place) return solids_;
    const auto around = [&](const Rect& places) {
        return Rect{places.low_x - reach_, places.low_y - reach_, places.high_x + reach_, places.high_y + reach_};
    };
    const auto contains = [](const Rect& outer, const Rect& inner) {
        return outer.low_x <= inner.low_x && outer.low_y <= inner.low_y && outer.high_x >= inner.high_x &&
               outer.high_y >= inner.high_y;
    };
    const Rect here{place.x(), place.y(), place.x(), place.y()}, area = around(here);
    place_.setConstant(std::numeric_limits<double>::quiet_NaN());  // remains so if a tile is damaged
    if (!contains(known_, area)) gather(expected_ && contains(*expected_, here) ? around(*expected_) : area, place);
    select(place, area);
    place_ = place;
    return solids_;
}

/// Finds the elements in an area. `origin` is a point near it.
void NearSolids::gather(const Rect& area, const Vec3& origin)
{
    known_ = {0, 0, -1, -1};
    elements_.clear();
    boxes_.clear();
    geometry_.impl().visit_in(
        area.low_x, area.low_y, area.high_x, area.high_y, [&](const Tile& tile, std::uint32_t number) {
            if (tile.label(number) == Label::Water || tile.label(number) == Label::Ignore) return;
            Element& element = elements_.emplace_back();
            element.part = tile.part(number);
            element.label = tile.label(number);
            if (tile.is_triangle(number))
                element.corners = tile.corners(number);
            else
                element.primitive = std::make_shared<const Convex>(convex_of(tile.primitive(number).shape()));
            boxes_.push_back(tile.box(number));
        });
    cover_shared(origin);
    numbers_.assign(elements_.size(), none);
    known_ = area;
}

/// Marks what nothing comes to lie on from above, unless it also lies on another triangle: corners and edges that
/// several triangles share, in all but one of them; and edges in a valley or in a plane, in both triangles. Leaves out
/// triangles that may be walls, because what touches them is examined one by one.
void NearSolids::cover_shared(const Vec3& origin)
{
    flat_edges_.clear();
    std::vector<std::optional<TouchTriangle>> triangles(elements_.size());
    std::vector<std::uint32_t> order;  // by the smallest x
    for (std::uint32_t e = 0; e < elements_.size(); ++e) {
        if (!elements_[e].primitive) triangles[e] = touch_triangle_of(moved_by(elements_[e].corners, -origin));
        if (is_ground(triangles[e])) order.push_back(e);
    }
    std::sort(order.begin(), order.end(),
              [&](std::uint32_t i, std::uint32_t j) { return boxes_[i].min[0] < boxes_[j].min[0]; });
    const auto overlap_in = [&](std::size_t axis, std::uint32_t i, std::uint32_t j) {
        return boxes_[i].min[axis] <= boxes_[j].max[axis] && boxes_[i].max[axis] >= boxes_[j].min[axis];
    };
    for (auto i = order.begin(); i != order.end(); ++i)
        for (auto j = i + 1; j != order.end() && overlap_in(0, *i, *j); ++j) {
            if (!overlap_in(1, *i, *j) || !overlap_in(2, *i, *j)) continue;
            const std::uint32_t first = std::min(*i, *j), second = std::max(*i, *j);
            cover_pair(first, second, *triangles[first], *triangles[second]);
        }
}

/// The same for two triangles.
void NearSolids::cover_pair(std::uint32_t i, std::uint32_t j, const TouchTriangle& first, const TouchTriangle& second)
{
    const auto is_same = [](const Vec3& p, const Vec3& q) {  // mostly, the first comparison decides
        return p.x() == q.x() && p.y() == q.y() && p.z() == q.z();
    };
    std::array<int, 3> same{-1, -1, -1};
    int count = 0;
    for (int k = 0; k < 3; ++k)
        for (int l = 0; l < 3; ++l) {
            if (!is_same(elements_[i].corners[std::size_t(k)], elements_[j].corners[std::size_t(l)])) continue;
            same[std::size_t(k)] = l;
            elements_[j].wanted.covered_points |= std::uint8_t(1 << l);
            ++count;
        }
    if (count != 2) return;
    const SharedEdge edge(same);
    elements_[j].wanted.covered_edges |= SharedEdge::edge_without(edge.other_alone);
    if (!edge.is_clear(first, second))
        flat_edges_.push_back({i, j, same});
    else if (edge.is_valley(first, second))
        elements_[i].wanted.covered_edges |= SharedEdge::edge_without(edge.alone);
}

/// Sets solids_ to the elements that meet a rectangle, relative to a place.
void NearSolids::select(const Vec3& place, const Rect& area)
{
    constexpr std::size_t most_covered = 48;  // with more solids, nothing counts as covered
    // For a float, these limits are the same as those of the rectangle.
    const float low_x = rounded_up(area.low_x), low_y = rounded_up(area.low_y), high_x = rounded_down(area.high_x),
                high_y = rounded_down(area.high_y);
    std::size_t count = 0;
    selected_.clear();
    for (std::uint32_t e = 0; e < elements_.size(); ++e) {
        const ElementBox& box = boxes_[e];
        if (box.min[0] <= high_x && box.max[0] >= low_x && box.min[1] <= high_y && box.max[1] >= low_y)
            selected_.push_back(e);
    }
    solids_.resize(selected_.size());
    for (const std::uint32_t e : selected_) {
        numbers_[e] = std::uint32_t(count);
        set(solids_[count++], elements_[e], place);
    }
    for (const auto& [first, second, same] : flat_edges_) {
        if (numbers_[first] == none || numbers_[second] == none) continue;
        const SharedEdge edge(same);
        NearSolid& solid = solids_[numbers_[first]];
        if (edge.is_valley(*solid.triangle, *solids_[numbers_[second]].triangle))
            solid.wanted.covered_edges |= SharedEdge::edge_without(edge.alone);
    }
    for (const std::uint32_t e : selected_) numbers_[e] = none;
    if (solids_.size() > most_covered)
        for (NearSolid& solid : solids_) solid.wanted = {};
}

/// Sets a solid to an element, relative to a place.
void NearSolids::set(NearSolid& solid, const Element& element, const Vec3& place)
{
    solid.part = element.part;
    solid.label = element.label;
    solid.wanted = element.wanted;
    solid.triangle.reset();
    solid.body.reset();
    if (element.primitive) {
        solid.body = std::make_unique<const Convex>(moved(*element.primitive, {-place, Mat3::Identity()}));
        solid.bounds = solid.body->bounds();
        return;
    }
    const std::array<Vec3, 3> corners = moved_by(element.corners, -place);
    solid.bounds = {corners[0].cwiseMin(corners[1]).cwiseMin(corners[2]),
                    corners[0].cwiseMax(corners[1]).cwiseMax(corners[2])};
    solid.triangle = touch_triangle_of(corners);
    if (!solid.triangle) solid.body = std::make_unique<const Convex>(convex_of(corners));
}

}  // namespace spawnfield
