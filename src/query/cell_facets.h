#pragma once

#include "base/polygon2.h"
#include "base/rect.h"
#include "geometry/geometry_impl.h"

#include <spawnfield/geometry.h>

#include <algorithm>
#include <array>
#include <cassert>
#include <limits>
#include <vector>

namespace spawnfield {

constexpr double proof_slack = 1e-8;  ///< m that heights and distances of a cell must keep from their limits

/// A convex polygon with few corners, counterclockwise. It allocates no memory.
class SmallPolygon {
public:
    static constexpr std::size_t most = 15;

    SmallPolygon() = default;
    SmallPolygon(std::initializer_list<Vec2> corners)
    {
        for (const Vec2& p : corners) push_back(p);
    }
    SmallPolygon(const SmallPolygon& from) { *this = from; }
    SmallPolygon& operator=(const SmallPolygon& from)  // copies only the corners that exist
    {
        size_ = from.size_;
        std::copy(from.begin(), from.end(), corners_.begin());
        return *this;
    }
    std::size_t size() const { return size_; }
    bool empty() const { return size_ == 0; }
    const Vec2& operator[](std::size_t k) const { return corners_[k]; }
    const Vec2* begin() const { return corners_.data(); }
    const Vec2* end() const { return corners_.data() + size_; }
    void push_back(const Vec2& p)
    {
        assert(size_ < most);
        corners_[size_++] = p;
    }
    void turn_round() { std::reverse(corners_.begin(), corners_.begin() + std::ptrdiff_t(size_)); }

private:
    std::array<Vec2, most> corners_;
    std::size_t size_ = 0;
};

SmallPolygon corners_of(const Rect& rect);

/// Returns the outward unit normal of the edge from p to q of a counterclockwise polygon.
Vec2 unit_edge_normal(const Vec2& p, const Vec2& q);

/// Returns whether an edge of one polygon separates the other polygon from it. The polygons may overlap by `by` m.
bool are_parted(const SmallPolygon& a, const SmallPolygon& b, double by);

/// The part of a rectangle that is left after convex polygons have been taken away.
class Remainder {
public:
    explicit Remainder(const Rect& rect) : left_{corners_of(rect)} {}

    void take(const SmallPolygon& polygon);
    bool is_empty() const { return left_.empty(); }
    bool is_hopeless() const { return left_.size() > 64; }

private:
    std::vector<SmallPolygon> left_, out_;
};

/// A flat piece of a surface, or the upper surface of a primitive. With has_plane, its heights are height + slope * (x,
/// y).
struct Facet {
    SmallPolygon polygon;  ///< seen from above; empty: the facet is vertical, or its outline is not known
    Interval z;            ///< heights within the cell
    double height = 0;
    Vec2 slope = Vec2::Zero();
    bool has_plane = false;
    bool terrain = false, water = false;
    bool filled = false;  ///< belongs to a filled mesh, so only some of its crossings are upper ends
    bool open = false;
    bool crossed = false;  ///< the vertical line through the cell's centre crosses it
    std::uint32_t piece = 0;
    std::uint64_t order = 0;  ///< Tile::order() of its element

    double at(double x, double y) const { return height + slope.x() * x + slope.y() * y; }
};

/// The terrain and water in a cell, as flat pieces. If a filled mesh has terrain, its other faces are included too,
/// because they separate the inside from the outside.
struct CellFacets {
    std::vector<Facet> all;
    bool has_too_many = false;  ///< `all` is incomplete, so only `terrain` may be used
    Interval terrain{std::numeric_limits<double>::infinity(),
                     -std::numeric_limits<double>::infinity()};  ///< range of the heights of all terrain

    CellFacets(const Geometry& geometry, const Rect& cell);

private:
    void set_plane(const Vec3& a, const Vec3& normal, const Interval& limits, Facet& out) const;
    void add_triangle(const Tile& tile, std::uint32_t element, bool other_filled);
    void add_primitive(const Tile& tile, std::uint32_t element);
    void add_box(const Shape& box, Label label, std::uint64_t order);

    const Rect cell_;
    const SmallPolygon corners_;
    bool has_filled_terrain_ = false;
};

}  // namespace spawnfield
