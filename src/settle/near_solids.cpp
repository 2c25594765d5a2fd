#include "settle/near_solids.h"

#include "base/rounding.h"

#include <algorithm>
#include <bit>
#include <cmath>

namespace spawnfield {
namespace {

/// Returns whether a triangle is ground. Steeper ones may be walls, and what touches them is examined fully.
bool is_ground(const TriangleShape& shape)
{
    constexpr double steepest = 2;
    return shape.unit_normal.head<2>().squaredNorm() <=
           steepest * steepest * shape.unit_normal.z() * shape.unit_normal.z();
}

std::array<Vec3, 3> moved_by(const std::array<Vec3, 3>& corners, const Vec3& by)
{
    return {corners[0] + by, corners[1] + by, corners[2] + by};
}

/// Returns whether a primitive is a box whose sides are parallel to the axes of the scene.
bool is_upright_box(const TilePrimitive& primitive)
{
    return primitive.kind == ShapeKind::Box && Mat3(primitive.rotation.data()) == Mat3::Identity();
}

/// The limits of a rectangle as floats. For boxes of floats, they are the same as those of the rectangle.
struct Limits {
    float low_x, low_y, high_x, high_y;

    explicit Limits(const Rect& area)
        : low_x(rounded_up(area.low_x)), low_y(rounded_up(area.low_y)), high_x(rounded_down(area.high_x)),
          high_y(rounded_down(area.high_y))
    {
    }

    bool meet(const ElementBox& box) const
    {
        return box.min[0] <= high_x && box.max[0] >= low_x && box.min[1] <= high_y && box.max[1] >= low_y;
    }
};

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
    double overhang(std::span<const Vec3> first, std::span<const Vec3> second) const
    {
        const Vec3 &shared = first[std::size_t(alone + 1) % 3], &own = first[std::size_t(alone)],
                   &other = second[std::size_t(other_alone)];
        const Vec2 edge = (first[std::size_t(alone + 2) % 3] - shared).head<2>();
        return cross(edge, (own - shared).head<2>()) * cross(edge, (other - shared).head<2>());
    }

    /// Returns whether nothing comes to lie on the edge that does not also lie on one of the triangles.
    bool is_valley(const TouchFace& first, const TouchFace& second) const
    {
        constexpr double flat = 1e-13;  // m
        const double rise = first.normal.dot(second.corners[std::size_t(other_alone)]) - first.height;
        return overhang(first.points(), second.points()) < 0 && !(rise < -flat);
    }
};

}  // namespace

const Convex& NearSolid::body() const
{
    if (body_) return *body_;
    if (box_ != nullptr) {
        body_ = std::make_unique<const Convex>(moved(convex_of(box_->shape()), {-place_, Mat3::Identity()}));
    } else {
        const auto& [a, b, c, unused] = face->corners;
        body_ = std::make_unique<const Convex>(convex_of({a, b, c}));
    }
    return *body_;
}

void NearSolid::set(const std::array<Vec3, 3>& triangle, const std::optional<TriangleShape>& known)
{
    const auto& [a, b, c] = triangle;
    bounds = {a.cwiseMin(b).cwiseMin(c), a.cwiseMax(b).cwiseMax(c)};
    set_touch_face(face, triangle, known);
    box_ = nullptr;
    body_ = face ? nullptr : std::make_unique<const Convex>(convex_of(triangle));
}

void NearSolid::set(const TilePrimitive& upright_box, const Vec3& place)
{
    const Vec3 middle(upright_box.position.data()), half = 0.5 * Vec3(upright_box.size.data());
    bounds = {middle - half - place, middle + half - place};  // to the bit those of body()
    face = top_of(bounds);
    body_.reset();
    box_ = &upright_box;
    place_ = place;
}

void NearSolid::set(Convex body)
{
    bounds = body.bounds();
    face.reset();
    box_ = nullptr;
    body_ = std::make_unique<const Convex>(std::move(body));
}

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
    if (!contains(known_, area)) gather(expected_ && contains(*expected_, here) ? around(*expected_) : area);
    select(place, area);
    place_ = place;
    return solids_;
}

/// Sets found_ to the elements that meet an area, in the order of the scene. The order of tiles is another one in a
/// changed scene than in the scene that was baked anew, and the last bits of a settled pose depend on the order.
void NearSolids::find(const Rect& area)
{
    tiles_.clear();
    found_.clear();
    const Limits limits(area);
    geometry_.impl().visit_tiles(area, [&](const Tile& tile, const ElementBox&) {
        for_each_bit(tile.near(area), [&](std::uint32_t number) {
            const Label label = tile.label(number);
            if (label == Label::Water || label == Label::Ignore) return;
            if (const ElementBox box = tile.box(number); limits.meet(box))
                found_.push_back({tile.order(number), std::uint32_t(tiles_.size()), number, box});
        });
        if (!found_.empty() && found_.back().tile == tiles_.size()) tiles_.push_back(tile);
    });
    std::sort(found_.begin(), found_.end(), [](const Found& l, const Found& r) { return l.order < r.order; });
}

/// Prepares the elements in an area.
void NearSolids::gather(const Rect& area)
{
    known_ = {0, 0, -1, -1};
    elements_.clear();
    boxes_.clear();
    find(area);
    for (const auto& [order, t, number, box] : found_) {
        const Tile& tile = tiles_[t];
        Element& element = elements_.emplace_back();
        element.part = tile.part(number);
        element.label = tile.label(number);
        if (tile.is_triangle(number)) {
            element.corners = tile.corners(number);
            element.shape = triangle_shape_of(element.corners);
        } else if (const TilePrimitive& primitive = tile.primitive(number); is_upright_box(primitive)) {
            element.box = &primitive;
        } else {
            element.primitive = std::make_shared<const Convex>(convex_of(primitive.shape()));
        }
        boxes_.push_back(box);
    }
    cover_shared();
    numbers_.assign(elements_.size(), none);
    known_ = area;
}

/// Begins anew, for at most so many points.
void PointTable::clear(std::size_t most)
{
    slots_.assign(std::bit_ceil(2 * most + 1), none);
    points_.clear();
}

std::uint32_t PointTable::number_of(const Vec3& point)
{
    const auto bits = [&](int axis) { return std::bit_cast<std::uint64_t>(point[axis] + 0.0); };  // -0 is 0
    constexpr std::uint64_t odd = 0x9E3779B97F4A7C15;
    const std::uint64_t hash = ((bits(0) * odd ^ bits(1)) * odd ^ bits(2)) * odd;
    std::size_t slot = hash >> 32 & (slots_.size() - 1);
    while (slots_[slot] != none && points_[slots_[slot]] != point) slot = (slot + 1) & (slots_.size() - 1);
    if (slots_[slot] == none) {
        slots_[slot] = std::uint32_t(points_.size());
        points_.push_back(point);
    }
    return slots_[slot];
}

/// Marks what nothing comes to lie on from above, unless it also lies on another triangle: corners and edges that
/// several triangles share, in all but one of them; and edges in a valley or in a plane, in both triangles. Leaves out
/// triangles that may be walls, because what touches them is examined one by one.
void NearSolids::cover_shared()
{
    flat_edges_.clear();
    numbers_of_points_.clear(3 * elements_.size());
    corners_.clear();
    last_corners_.clear();
    for (std::uint32_t e = 0; e < elements_.size(); ++e) {
        Element& element = elements_[e];
        if (!element.shape || !is_ground(*element.shape)) continue;
        std::array<std::uint32_t, 3> points;
        for (std::size_t k = 0; k < 3; ++k) {
            points[k] = numbers_of_points_.number_of(element.corners[k]);
            if (points[k] < last_corners_.size())
                element.wanted.covered_points |= std::uint8_t(1 << k);
            else
                last_corners_.push_back(none);
        }
        std::array<Corner, 3> corners;
        for (std::size_t k = 0; k < 3; ++k)
            corners[k] = {e, std::uint32_t(k), points[(k + 1) % 3], points[(k + 2) % 3], last_corners_[points[k]]};
        for (const Corner& corner : corners)
            for (std::uint32_t c = corner.before; c != none; c = corners_[c].before)
                if (const Corner& other = corners_[c]; other.next == corner.next || other.last == corner.next)
                    cover_edge(other, corner);
        for (const Corner& corner : corners) {
            last_corners_[points[corner.index]] = std::uint32_t(corners_.size());
            corners_.push_back(corner);
        }
    }
}

/// The same for the edges of two triangles that begin at a corner which they share, and lead to the next corner of the
/// second one.
void NearSolids::cover_edge(const Corner& corner, const Corner& other)
{
    constexpr double clear = 1e-10;  // m or m^4: more than what rounding changes
    const bool is_next = corner.next == other.next;
    if ((is_next ? corner.last : corner.next) == other.last) return;  // the same triangle again
    std::array<int, 3> same;
    same[corner.index] = int(other.index);
    same[(corner.index + (is_next ? 1 : 2)) % 3] = int(other.index + 1) % 3;
    same[(corner.index + (is_next ? 2 : 1)) % 3] = -1;
    const SharedEdge edge(same);
    Element &first = elements_[corner.element], &second = elements_[other.element];
    second.wanted.covered_edges |= SharedEdge::edge_without(edge.other_alone);
    const Vec3& normal = first.shape->unit_normal;
    const double overhang = edge.overhang(first.corners, second.corners),
                 rise = normal.dot(second.corners[std::size_t(edge.other_alone)] - first.corners[0]) / normal.z();
    if (std::abs(overhang) <= clear || std::abs(rise) <= clear)
        flat_edges_.push_back({corner.element, other.element, same});
    else if (overhang < 0 && rise > 0)
        first.wanted.covered_edges |= SharedEdge::edge_without(edge.alone);
}

/// Sets solids_ to the elements that meet a rectangle, relative to a place.
void NearSolids::select(const Vec3& place, const Rect& area)
{
    constexpr std::size_t most_covered = 48;  // with more solids, nothing counts as covered
    const Limits limits(area);
    std::size_t count = 0;
    selected_.clear();
    for (std::uint32_t e = 0; e < elements_.size(); ++e)
        if (limits.meet(boxes_[e])) selected_.push_back(e);
    solids_.resize(selected_.size());
    for (const std::uint32_t e : selected_) {
        numbers_[e] = std::uint32_t(count);
        set(solids_[count++], elements_[e], place);
    }
    for (const auto& [first, second, same] : flat_edges_) {
        if (numbers_[first] == none || numbers_[second] == none) continue;
        const SharedEdge edge(same);
        NearSolid& solid = solids_[numbers_[first]];
        if (edge.is_valley(*solid.face, *solids_[numbers_[second]].face))
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
    if (element.box != nullptr)
        solid.set(*element.box, place);
    else if (element.primitive)
        solid.set(moved(*element.primitive, {-place, Mat3::Identity()}));
    else
        solid.set(moved_by(element.corners, -place), element.shape);
}

}  // namespace spawnfield
