#pragma once

#include "base/rect.h"
#include "geometry/geometry_impl.h"
#include "settle/touch.h"

#include <memory>
#include <optional>
#include <vector>

namespace spawnfield {

/// A part of the scene near a robot, relative to the place where the robot is let down.
class NearSolid {
public:
    /// Of a triangle that is not steep, and of a box whose sides are parallel to the axes: what touches from above.
    std::optional<TouchFace> face;
    Bounds bounds;
    std::uint32_t part = 0;
    Label label = Label::Terrain;
    WantedTouches wanted;  ///< of robots that lie on the ground of all solids

    /// Returns the whole solid. If it has a face, the solid is made when it is first needed: near a robot in a scan are
    /// ten thousand voxels, and most are only touched from above.
    const Convex& body() const;

    // Each of these sets the face, the bounds and the body.
    void set(const std::array<Vec3, 3>& triangle, const std::optional<TriangleShape>& known = {});
    void set(const TilePrimitive& upright_box, const Vec3& place);  ///< keeps a pointer to the box
    void set(Convex body);

private:
    mutable std::unique_ptr<const Convex> body_;  ///< null: not made yet
    const TilePrimitive* box_ = nullptr;
    Vec3 place_ = Vec3::Zero();  ///< of the robot, if it is a box
};

/// Numbers points in the order in which they are first seen. Equal points get the same number. Unlike PointNumbers, it
/// keeps its memory for the next points, because it is used for each robot that is let down.
class PointTable {
public:
    void clear(std::size_t most);
    std::uint32_t number_of(const Vec3& point);

private:
    static constexpr std::uint32_t none = std::uint32_t(-1);
    std::vector<std::uint32_t> slots_;  ///< numbers of points, or none
    std::vector<Vec3> points_;
};

/// Finds the solids near one place after the other. Places that follow each other in a small area share work.
class NearSolids {
public:
    /// `reach` is the distance of the robot's farthest point from its origin, m.
    NearSolids(const Geometry& geometry, double reach) : geometry_(geometry), reach_(reach) {}

    /// Announces that most of the next places are in this rectangle: its solids are prepared once for all of them.
    void expect(const Rect& places) { expected_ = places; }

    /// Returns the solids that the robot may meet at a place, relative to the place.
    const std::vector<NearSolid>& at(const Vec3& place);

private:
    /// An element of the geometry, in the scene's frame.
    struct Element {
        std::array<Vec3, 3> corners;              ///< of a triangle
        std::optional<TriangleShape> shape;       ///< of a triangle that is not steep
        const TilePrimitive* box = nullptr;       ///< of a box whose sides are parallel to the axes
        std::shared_ptr<const Convex> primitive;  ///< of other primitives
        std::uint32_t part;
        Label label;
        WantedTouches wanted;
    };
    struct Found {
        std::uint64_t order;         ///< Tile::order()
        std::uint32_t tile, number;  ///< index in tiles_, and element of that tile
        ElementBox box;
    };
    /// Two triangles with a common edge, which may be a ridge or a valley by rounding only.
    struct FlatEdge {
        std::uint32_t first, second;  ///< indices in elements_
        std::array<int, 3> same;      ///< corner k of the first one is corner same[k] of the second one, -1: none
    };
    /// A corner of a triangle.
    struct Corner {
        std::uint32_t element, index;  ///< the triangle, and which of its corners
        std::uint32_t next, last;      ///< numbers of the points of the next corner, and of the one after that
        std::uint32_t before;          ///< index in corners_ of an earlier one at the same point, or none
    };
    static constexpr std::uint32_t none = std::uint32_t(-1);

    void find(const Rect& area);
    void gather(const Rect& area);
    void cover_shared();
    void cover_edge(const Corner& corner, const Corner& other);
    void select(const Vec3& place, const Rect& area);
    static void set(NearSolid& solid, const Element& element, const Vec3& place);

    Geometry geometry_;
    double reach_;
    std::optional<Rect> expected_;
    Rect known_{0, 0, -1, -1};       ///< all elements that meet this rectangle are in elements_
    std::vector<Element> elements_;  ///< in the order of the scene
    std::vector<ElementBox> boxes_;  ///< of elements_
    std::vector<FlatEdge> flat_edges_;
    Vec3 place_ = Vec3::Constant(std::numeric_limits<double>::quiet_NaN());
    std::vector<NearSolid> solids_;        ///< at place_
    std::vector<std::uint32_t> selected_;  ///< of solids_: their index in elements_
    std::vector<std::uint32_t> numbers_;   ///< of elements_: their index in solids_, or none
    // Only used by gather():
    std::vector<Tile> tiles_;
    std::vector<Found> found_;
    // Only used by cover_shared():
    PointTable numbers_of_points_;
    std::vector<Corner> corners_;
    std::vector<std::uint32_t> last_corners_;  ///< of each point, an index in corners_
};

}  // namespace spawnfield
