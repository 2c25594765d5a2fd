#pragma once

#include "base/polygon2.h"
#include "settle/convex.h"

#include <array>
#include <cstdint>
#include <limits>
#include <optional>
#include <span>
#include <vector>

namespace spawnfield {

/// A possible contact of a body that is lowered onto the ground: if no higher touch stops it, it comes to lie there.
struct Touch {
    enum class Kind : std::uint8_t {
        CornerOnFace,     ///< `body` is a point of a polyhedron
        RimOnFace,        ///< `body` is a point of a cylinder
        CornerUnderFace,  ///< `ground` is a point, `body` a plane
        EdgeOnEdge,
        Other
    };

    double height;  ///< m by which the body must be raised until it only just touches here; negative: lowered
    Vec3 point;     ///< of the body, before it is raised
    Vec3 normal;    ///< of the touching surfaces, from the ground towards the body, scaled so that z is 1
    Kind kind = Kind::Other;
    std::uint32_t body = 0, ground = 0;  ///< indices, see Kind
};

/// The touches that a caller needs. Others may be left out.
struct WantedTouches {
    double min_height = -std::numeric_limits<double>::infinity();  ///< m
    /// Bit k: touches of this edge or corner of the ground are not needed. From number 8 on, all are needed.
    std::uint8_t covered_edges = 0, covered_points = 0;

    bool wants_edge(std::size_t k) const { return k >= 8 || (covered_edges >> k & 1) == 0; }
    bool wants_point(std::size_t k) const { return k >= 8 || (covered_points >> k & 1) == 0; }
};

/// A face of the scene that is not steep, prepared for many touches from above: a triangle, or the top of an upright
/// box. A robot that meets the box from above touches nothing else of it.
struct TouchFace {
    static constexpr double steepest = 20;  ///< largest slope
    static constexpr std::size_t most = 4;  ///< corners

    std::size_t count;               ///< 3 or 4 corners, in order
    std::array<Vec3, most> corners;  ///< the first `count` of them
    Vec3 normal;                     ///< scaled so that z is 1; the plane is where normal . p = height
    double height;                   ///< of the plane at x = y = 0, m
    struct Side {
        Vec2 inward;    ///< of length 1
        double offset;  ///< m; inside, inward . p >= offset
    };
    std::array<Side, most> sides;  ///< of the edges, seen from above

    std::span<const Vec3> points() const { return {corners.data(), count}; }
    /// Edge k is from corner k to the next one.
    std::span<const std::array<int, 2>> edges() const;
    double z_at(const Vec3& p) const { return height - normal.x() * p.x() - normal.y() * p.y(); }
    bool is_over(const Vec3& p) const;  ///< whether p is above or below the face or its edges (to 1e-12 m)
};

/// What of the TouchFace of a triangle does not depend on where it is.
struct TriangleShape {
    std::array<Vec3, 3> sides;    ///< side k is from corner k to the next corner
    Vec3 unit_normal;             ///< of length 1
    std::array<Vec2, 3> inwards;  ///< TouchFace::Side::inward
};

/// Returns nothing if the triangle is steeper than TouchFace::steepest or has no area.
std::optional<TouchFace> touch_face_of(const std::array<Vec3, 3>& triangle);
std::optional<TriangleShape> triangle_shape_of(const std::array<Vec3, 3>& triangle);

/// Sets `out` to the same, of a triangle whose shape is known from another place. If its sides differ from those there
/// by rounding, the shape is computed anew: so the result is always the same as without `known`.
void set_touch_face(std::optional<TouchFace>& out, const std::array<Vec3, 3>& triangle,
                    const std::optional<TriangleShape>& known);

/// Returns the top of a box whose sides are parallel to the axes.
TouchFace top_of(const Bounds& box);

/// A convex body at its current attitude, prepared for many touches from above.
struct PlacedBody {
    Convex body;
    Bounds bounds = {};
    /// Only of polyhedra: the corners and edges of the faces that look downwards. Nothing below touches the others.
    struct Corners {
        std::vector<double> x, y, z;         ///< an even number of values: the last corner may be there twice
        std::vector<std::uint32_t> indices;  ///< in body.points
    };
    struct Edge {
        std::uint32_t from, to;  ///< indices in lower_corners
        std::uint32_t index;     ///< in body.edges
    };
    Corners lower_corners = {};
    std::vector<Edge> lower_edges = {};
    /// A bit for each plane that looks downwards: those for which the corners and edges were chosen. Nothing: they must
    /// be chosen anew.
    std::optional<std::uint64_t> lower_planes = {};
};

/// Sets `out` to the body, rotated about the origin of the body's frame. out.body must be a copy of the body or the
/// result of an earlier call for it.
void place(PlacedBody& out, const Convex& body, const Mat3& rotation);

/// Returns how far the body must be raised at most until it is not below the face's plane, m.
double height_bound(const PlacedBody& placed, const TouchFace& face);

/// Adds the touches of a body that moves only along z and meets the ground, a convex solid, from above. At the height
/// of the highest touch the body rests on the ground: on no vertical line is the ground's upper end above the body's
/// lower end. The other touches are lower; one of them may become the highest if the body is turned a little. Of two
/// round bodies, adds only the highest touch of the bodies and of their ends. Surfaces steeper than 1e5 have no
/// touches. Adds nothing if body and ground do not overlap seen from above.
void add_touches(const Convex& body, const Convex& ground, std::vector<Touch>& out, const WantedTouches& wanted = {});
void add_touches(const PlacedBody& placed, const TouchFace& ground, std::vector<Touch>& out,
                 const WantedTouches& wanted = {});

/// Returns the height of a touch of the body on a face after the body has been rotated from its own frame, if the
/// same two features still touch: it is not tested whether they still meet. Returns nothing for Kind::Other, or if they
/// are parallel.
std::optional<double> height_after(const Touch& touch, const Convex& body, const Mat3& rotation,
                                   const TouchFace& ground);

/// Returns the highest of these touches for any two bodies, by a general method that takes longer.
std::optional<Touch> highest_touch(const Convex& body, const Convex& ground);

/// Returns the interval of heights (see Touch::height) in which the raised body overlaps the solid, or nothing if they
/// do not overlap seen from above.
std::optional<Interval> blocked_heights(const Convex& body, const Convex& solid);

/// Returns the lower end of this interval, of bodies that overlap seen from above.
double lowest_blocked(const Convex& body, const Convex& solid);

/// Returns the z of a body's upper end on the vertical line through (x, y), or nothing if the line misses the body.
std::optional<double> upper_end(const Convex& body, double x, double y);

/// The same for the lower end of a body at its current attitude.
std::optional<double> lower_end(const PlacedBody& placed, double x, double y);

}  // namespace spawnfield
