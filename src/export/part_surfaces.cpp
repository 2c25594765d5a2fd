#include "export/part_surfaces.h"

#include "base/parallel.h"
#include "export/tessellation.h"
#include "geometry/geometry_impl.h"

#include <algorithm>
#include <bit>

namespace spawnfield {
namespace {

struct CornersOfTriangle {
    std::array<Point, 3> corners;
    std::uint32_t part = 0;
    Label label = Label::Terrain;
};

struct Elements {
    std::vector<CornersOfTriangle> triangles;
    std::vector<Primitive> primitives;
};

/// Calls visit(tile, element) for each element of the scene, on several threads.
template <class Visit>
void for_each_element(const Geometry::Impl& geometry, int threads, const Visit& visit)
{
    geometry.for_each_tree([&](const Forest& forest, std::size_t tree) {
        parallel_for(forest.trees[tree].boxes().size(), threads, {}, [&](std::size_t t) {
            const Tile tile = geometry.open(forest, tree, t);
            for (const std::uint32_t id : tile.ids)
                if (id >= geometry.next.element) forest.tiles.fail_inconsistent();
            for_each_bit(tile.alive, [&](std::uint32_t element) { visit(tile, element); });
        });
    });
}

/// Returns the scene's elements in the scene's order. Tiles have another order; the numbers of elements are ascending
/// in the scene, but some may be missing in a changed scene.
Elements elements_of(const Geometry& geometry, const std::function<Point(const Vec3&)>& to_point, int threads)
{
    enum class Kind : std::uint8_t { None, Triangle, Primitive };
    const auto kind_of = [](const Tile& tile, std::uint32_t element) {
        return tile.is_triangle(element) ? Kind::Triangle : Kind::Primitive;
    };
    const Geometry::Impl& impl = geometry.impl();
    impl.expect_all();
    std::vector<Kind> kinds(impl.next.element, Kind::None);
    for_each_element(impl, threads, [&](const Tile& tile, std::uint32_t element) {
        kinds[tile.ids[element]] = kind_of(tile, element);
    });
    std::vector<std::uint32_t> places(kinds.size());
    std::uint32_t triangles = 0, primitives = 0;
    for (std::size_t id = 0; id < kinds.size(); ++id)
        if (kinds[id] != Kind::None) places[id] = kinds[id] == Kind::Triangle ? triangles++ : primitives++;
    Elements out;
    out.triangles.resize(triangles);
    out.primitives.resize(primitives);
    for_each_element(impl, threads, [&](const Tile& tile, std::uint32_t element) {
        const std::uint32_t id = tile.ids[element], place = places[id];
        if (kinds[id] != kind_of(tile, element))
            impl.forests.front()->tiles.fail_inconsistent();  // two have one number
        if (tile.is_triangle(element)) {
            CornersOfTriangle& to = out.triangles[place];
            const auto corners = tile.corners(element);
            for (std::size_t c = 0; c < 3; ++c) to.corners[c] = to_point(corners[c]);
            to.part = tile.part(element);
            to.label = tile.label(element);
        } else {
            const TilePrimitive& from = tile.primitive(element);
            out.primitives[place] = {from.shape(), from.part, from.label};
        }
    });
    return out;
}

/// Returns the number of sides of round solids: fewer if there are many, because each has many triangles.
int sides_for(const Elements& elements)
{
    const auto round = std::count_if(elements.primitives.begin(), elements.primitives.end(),
                                     [](const Primitive& p) { return p.shape.kind != ShapeKind::Box; });
    return round > 20000 ? 8 : round > 2000 ? 16 : 32;
}

/// The elements of a part, which are consecutive: from `from` to before `to`.
struct Range {
    std::size_t from = 0, to = 0;
};

template <class Element>
std::vector<Range> ranges_by_part(const std::vector<Element>& elements, std::size_t parts)
{
    std::vector<Range> out(parts);
    for (std::size_t e = 0; e < elements.size(); ++e) {
        Range& range = out[elements[e].part];
        if (range.to == 0) range.from = e;
        range.to = e + 1;
    }
    return out;
}

}  // namespace

std::size_t Surface::PointHash::operator()(const Point& p) const
{
    std::size_t hash = 0;
    for (const float x : p) hash = hash * 1000003 + std::bit_cast<std::uint32_t>(x);
    return hash;
}

std::uint32_t Surface::number_of(const Point& point)
{
    const auto [entry, is_new] = numbers_.try_emplace(point, std::uint32_t(points_.size()));
    if (is_new) points_.push_back(point);
    return entry->second;
}

void for_each_part(const Geometry& geometry, const std::function<Point(const Vec3&)>& to_point, int threads,
                   const std::function<void(std::size_t part, const PartSurfaces& surfaces)>& visit)
{
    const Elements elements = elements_of(geometry, to_point, threads);
    const int sides = sides_for(elements);
    const std::size_t parts = geometry.parts().size();
    const std::vector<Range> triangles = ranges_by_part(elements.triangles, parts),
                             primitives = ranges_by_part(elements.primitives, parts);
    for (std::size_t part = 0; part < parts; ++part) {
        PartSurfaces surfaces;
        for (std::size_t e = triangles[part].from; e < triangles[part].to; ++e) {
            const CornersOfTriangle& triangle = elements.triangles[e];
            const auto& [a, b, c] = triangle.corners;
            surfaces[std::size_t(triangle.label)].add(a, b, c);
        }
        for (std::size_t e = primitives[part].from; e < primitives[part].to; ++e) {
            const Primitive& primitive = elements.primitives[e];
            Surface& surface = surfaces[std::size_t(primitive.label)];
            tessellate(primitive.shape, sides, [&](const Vec3& a, const Vec3& b, const Vec3& c) {
                surface.add(to_point(a), to_point(b), to_point(c));
            });
        }
        visit(part, surfaces);
    }
}

}  // namespace spawnfield
