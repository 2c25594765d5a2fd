#pragma once

#include "base/bits.h"
#include "base/four.h"
#include "base/rect.h"
#include "base/rounding.h"
#include "geometry/triangle_grid.h"

#include <spawnfield/scene.h>
#include <spawnfield/shape.h>

#include <algorithm>
#include <array>
#include <cstring>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace spawnfield {

// The records of a tile have the same bytes in memory and in geometry.bin, without padding. The arrays of records that
// contain doubles come first in a tile, and their sizes are multiples of 8 bytes, so that all arrays are aligned.

/// The bounding box of an element or of a tile, widened by 1e-8 m and rounded outwards.
struct ElementBox {
    std::array<float, 3> min, max;
};
static_assert(sizeof(ElementBox) == 24);

/// Extends a box so that it contains another one.
inline void extend(ElementBox& box, const ElementBox& by)
{
    for (std::size_t axis = 0; axis < 3; ++axis) {
        box.min[axis] = std::min(box.min[axis], by.min[axis]);
        box.max[axis] = std::max(box.max[axis], by.max[axis]);
    }
}

/// Returns whether two closed boxes have a point in common.
inline bool overlap(const ElementBox& a, const Bounds& b)
{
    return a.min[0] <= b.max[0] && a.max[0] >= b.min[0] && a.min[1] <= b.max[1] && a.max[1] >= b.min[1] &&
           a.min[2] <= b.max[2] && a.max[2] >= b.min[2];
}

/// Returns the ElementBox of these bounds.
inline ElementBox widened(const Bounds& bounds)
{
    constexpr double pad = 1e-8;  // m; wider than touch_tolerance, so a line on an edge finds its triangle
    ElementBox out{};
    for (int axis = 0; axis < 3; ++axis) {
        out.min[std::size_t(axis)] = rounded_down(bounds.min[axis] - pad);
        out.max[std::size_t(axis)] = rounded_up(bounds.max[axis] + pad);
    }
    return out;
}

struct TileTriangle {
    std::array<std::uint8_t, 3> corners;  ///< indices in the tile's vertices
    std::uint8_t piece;                   ///< index in the tile's pieces
    Label label;
};
static_assert(sizeof(TileTriangle) == 5);

/// The faces of a piece that have the same face group.
struct TilePiece {
    double bottom;        ///< Piece::bottom, m
    std::uint32_t piece;  ///< index in the scene
    std::uint32_t part;
    std::uint8_t solid, open, sides_up, unused;
    std::uint32_t group;  ///< as in Scene::triangle_groups
};
static_assert(sizeof(TilePiece) == 24);

struct TilePrimitive {
    std::array<double, 3> size, position;
    std::array<double, 9> rotation;  ///< column by column
    ElementBox box;
    std::uint32_t part;
    ShapeKind kind;
    Label label;
    std::array<std::uint8_t, 2> unused;

    Shape shape() const { return {kind, Vec3(size.data()), {Vec3(position.data()), Mat3(rotation.data())}}; }
};
static_assert(sizeof(TilePrimitive) == 152);

/// Turns coordinates along one axis of a tile into numbers 0 .. 255. A larger coordinate never gets a smaller number.
struct TileScale {
    float low, per_metre;

    std::uint8_t number_of(double coordinate) const
    {
        return std::uint8_t(std::max(0.0, std::min((coordinate - double(low)) * double(per_metre), 255.0)));  // NaN: 0
    }
    /// Returns the numbers of two coordinates, each in all bytes.
    std::array<SixteenBytes, 2> numbers_of(const Two& coordinates) const
    {
        const Two numbers = (coordinates - double(low)) * double(per_metre);
        return in_all_bytes(greatest(least(both(255), numbers), Two{}));  // in this order, NaN becomes 0
    }
};

struct TileHead {
    std::array<TileScale, 3> scales;  ///< of x, y, z
    std::uint8_t vertices, triangles, primitives, pieces;
    TriangleGridSize grid;
};
static_assert(sizeof(TileHead) == 32);

/// For each element of a tile, the numbers of its box: smallest x, y, z, then largest x, y, z. They are one array for
/// each limit, so that 16 elements are compared at a time.
struct TileBoxes {
    static constexpr std::size_t most = 64;  ///< elements of a tile
    std::array<std::array<std::uint8_t, most>, 3> min, max;
};
static_assert(sizeof(TileBoxes) == 384);

/// Numbers of the first element, piece, part and face group of a scene whose tiles are added to those of another scene.
struct ElementNumbers {
    std::uint32_t element = 0, piece = 0, part = 0, group = 0;
};

/// How many parts and face groups there are: numbers of parts in a tile are below, those of groups at most this.
struct TileLimits {
    std::size_t parts = 0, groups = 0;
};

/// A view of a tile's bytes as typed arrays. A tile has at most 64 elements that lie near each other. They are
/// numbered: first its triangles, then its primitives, both in the order of the scene.
struct Tile {
    const TileHead* head;
    const TileBoxes* boxes;
    const char* grid_bytes;  ///< behind the boxes
    std::span<const Vec3> vertices;
    std::span<const TilePrimitive> primitives;
    std::span<const TilePiece> pieces;
    std::span<const std::uint32_t> ids;  ///< the elements' numbers in the scene, ascending
    std::span<const TileTriangle> triangles;
    /// A bit for each element that exists. Elements of removed parts (changed_geometry.h) are not alive.
    std::uint64_t alive;

    /// Reads the head and finds the arrays behind it. The head's counts must fit the bytes (see tile_size).
    explicit Tile(std::string_view bytes);

    std::uint32_t elements() const { return std::uint32_t(head->triangles) + head->primitives; }
    bool has_grid() const { return head->grid.exists(); }
    /// Returns the grid, which the tile must have.
    TriangleGrid grid() const { return {head->grid, grid_bytes}; }
    bool is_triangle(std::uint32_t element) const { return element < head->triangles; }
    /// Returns a bit for each element that is a triangle.
    std::uint64_t are_triangles() const { return bits_between(0, int(head->triangles) - 1); }
    std::array<Vec3, 3> corners(std::uint32_t triangle) const
    {
        const auto [a, b, c] = corner_pointers(triangle);
        return {*a, *b, *c};
    }
    std::array<const Vec3*, 3> corner_pointers(std::uint32_t triangle) const
    {
        const auto& [a, b, c] = triangles[triangle].corners;
        return {&vertices[a], &vertices[b], &vertices[c]};
    }
    const TilePiece& piece(std::uint32_t triangle) const { return pieces[triangles[triangle].piece]; }
    const TilePrimitive& primitive(std::uint32_t element) const { return primitives[element - head->triangles]; }
    /// Returns a number that orders the elements of all tiles as in their scene: triangles first. The order is the same
    /// in a changed scene as in the scene that was baked anew.
    std::uint64_t order(std::uint32_t element) const
    {
        constexpr std::uint64_t behind_triangles = std::uint64_t{1} << 32;
        return ids[element] + (is_triangle(element) ? 0 : behind_triangles);
    }
    Label label(std::uint32_t element) const
    {
        return is_triangle(element) ? triangles[element].label : primitive(element).label;
    }
    std::uint32_t part(std::uint32_t element) const
    {
        return is_triangle(element) ? piece(element).part : primitive(element).part;
    }
    /// Returns the face group of an element, as in Scene::triangle_groups; 0 for a primitive.
    std::uint32_t group(std::uint32_t element) const { return is_triangle(element) ? piece(element).group : 0; }
    /// Returns the bounds of an element, m.
    Bounds bounds(std::uint32_t element) const
    {
        if (!is_triangle(element)) {
            const ElementBox& box = primitive(element).box;
            return {Vec3(box.min[0], box.min[1], box.min[2]), Vec3(box.max[0], box.max[1], box.max[2])};
        }
        const auto [a, b, c] = corners(element);
        return {a.cwiseMin(b).cwiseMin(c), a.cwiseMax(b).cwiseMax(c)};
    }
    /// Elements of other parts are not alive from now on.
    template <class IsKept>
    void keep(const IsKept& is_kept)
    {
        const auto all_kept = [&](const auto& list) {
            return std::all_of(list.begin(), list.end(), [&](const auto& item) { return is_kept(item.part); });
        };
        if (all_kept(pieces) && all_kept(primitives)) return;
        for (std::uint32_t e = 0; e < elements(); ++e)
            if (!is_kept(part(e))) alive &= ~(std::uint64_t{1} << e);
    }
    ElementBox box(std::uint32_t element) const
    {
        return is_triangle(element) ? widened(bounds(element)) : primitive(element).box;
    }

    /// Returns a bit for each element that is alive and whose box may meet the closed rectangle. If it is 0, the box
    /// certainly does not meet it.
    std::uint64_t near(const Rect& area) const
    {
        return marks<0, 2>({number(0, area.low_x), number(1, area.low_y)},
                           {number(0, area.high_x), number(1, area.high_y)});
    }
    /// The same for a point.
    std::uint64_t near(double x, double y) const
    {
        const std::array<SixteenBytes, 2> at{number(0, x), number(1, y)};
        return marks<0, 2>(at, at);
    }
    // The same for a line along y, and for a line along x. Both together are near() for the point where they cross.
    std::uint64_t near_x(double x) const
    {
        const std::array<SixteenBytes, 1> at{number(0, x)};
        return marks<0, 1>(at, at);
    }
    std::uint64_t near_y(double y) const
    {
        const std::array<SixteenBytes, 1> at{number(1, y)};
        return marks<1, 1>(at, at);
    }
    /// The same for a closed box.
    std::uint64_t near(const Bounds& space) const
    {
        const auto [low_x, high_x] = head->scales[0].numbers_of(Two{space.min.x(), space.max.x()});
        const auto [low_y, high_y] = head->scales[1].numbers_of(Two{space.min.y(), space.max.y()});
        const std::uint64_t from_above = marks<0, 2>({low_x, low_y}, {high_x, high_y});
        if (from_above == 0) return 0;
        const auto [low_z, high_z] = head->scales[2].numbers_of(Two{space.min.z(), space.max.z()});
        return from_above & marks<2, 1>({low_z}, {high_z});
    }

private:
    /// Returns the number of a coordinate, in all bytes.
    SixteenBytes number(std::size_t axis, double coordinate) const
    {
        return SixteenBytes{} + head->scales[axis].number_of(coordinate);
    }

    /// Compares the elements' boxes with a box of these numbers, along axis `First` and those that follow it.
    template <std::size_t First, std::size_t Axes>
    std::uint64_t marks(const std::array<SixteenBytes, Axes>& from, const std::array<SixteenBytes, Axes>& to) const
    {
        std::uint64_t out = 0;
        for (std::size_t e = 0; e < TileBoxes::most; e += sizeof(SixteenBytes)) {
            SixteenBytes gaps{};  // 0 where boxes meet
            for (std::size_t k = 0; k < Axes; ++k) {
                const SixteenBytes min = sixteen_at(boxes->min[First + k].data() + e),
                                   max = sixteen_at(boxes->max[First + k].data() + e);
                gaps |= excess(min, to[k]) | excess(from[k], max);
            }
            out |= std::uint64_t{bits_of(SixteenBytes(gaps == 0))} << e;
        }
        return out & alive;
    }
};

/// Returns the size of a tile with this head, bytes, without the padding at its end.
std::uint64_t tile_size(const TileHead& head);

/// Returns whether all counts and indices of a tile fit its bytes and the limits.
bool is_consistent_tile(std::string_view bytes, const TileLimits& limits);

/// Returns the bytes of a tile with these elements of the scene, which must be ascending; at most TileBoxes::most.
/// `boxes` has the boxes of all elements of the scene. The numbers of elements, pieces, parts and face groups in the
/// tile are those in the scene plus `first`.
std::string tile_of(const Scene& scene, const std::vector<ElementBox>& boxes, std::span<const std::uint32_t> elements,
                    const ElementNumbers& first);

}  // namespace spawnfield
