#include "base/parallel.h"
#include "geometry/geometry_impl.h"
#include "geometry/part_hashes.h"
#include "scene/elements.h"

#include <cmath>
#include <iterator>

namespace spawnfield {
namespace {

/// Sorts elements by size, so that a large one does not widen the tile of many small ones. The first group has all that
/// are shorter than a tile of average elements; the limit of each further group is four times that of the one before.
/// Empty groups are left out.
std::vector<std::vector<std::uint32_t>> groups_by_size(const std::vector<ElementBox>& boxes, const Bounds& bounds,
                                                       std::span<const std::uint32_t> elements)
{
    constexpr double factor = 4;
    const Vec3 extent = bounds.max - bounds.min;
    const double tile = std::sqrt(std::max(extent.x(), 1e-3) * std::max(extent.y(), 1e-3) * TileBoxes::most /
                                  double(elements.size()));
    std::vector<std::vector<std::uint32_t>> groups(1);
    for (const std::uint32_t element : elements) {
        const ElementBox& box = boxes[element];
        const double size = std::max(double(box.max[0]) - box.min[0], double(box.max[1]) - box.min[1]);
        std::size_t group = 0;
        for (double longest = tile; longest < size; longest *= factor) ++group;
        if (group >= groups.size()) groups.resize(group + 1);
        groups[group].push_back(element);
    }
    std::erase_if(groups, [](const auto& group) { return group.empty(); });
    return groups;
}

/// Returns the elements that share a tree. Terrain is apart from everything else, so that tiles of a heightmap are
/// grids (triangle_grid.h) under houses and trees, too.
std::vector<std::vector<std::uint32_t>> groups_of(const Scene& scene, const std::vector<ElementBox>& boxes)
{
    std::array<std::vector<std::uint32_t>, 2> terrain_and_others;
    for (std::uint32_t element = 0; element < boxes.size(); ++element)
        terrain_and_others[element_label(scene, element) == Label::Terrain ? 0 : 1].push_back(element);
    std::vector<std::vector<std::uint32_t>> out;
    for (const std::vector<std::uint32_t>& elements : terrain_and_others) {
        if (elements.empty()) continue;
        auto groups = groups_by_size(boxes, scene.bounds(), elements);
        std::move(groups.begin(), groups.end(), std::back_inserter(out));
    }
    return out;
}

ElementBox box_around(const std::vector<ElementBox>& boxes, std::span<const std::uint32_t> elements)
{
    ElementBox out = boxes[elements.front()];
    for (const std::uint32_t element : elements) extend(out, boxes[element]);
    return out;
}

}  // namespace

double Geometry::Impl::elements_near(const Rect& area) const
{
    constexpr double bytes_per_element = 40;
    // Returns the share of from .. to that lies in low .. high.
    const auto share = [](double low, double high, double from, double to) {
        return to > from ? std::clamp((std::min(high, to) - std::max(low, from)) / (to - from), 0.0, 1.0) : 1.0;
    };
    double sum = 0;
    find_tiles(area, [&](const Forest& forest, std::size_t tree, std::size_t tile, const ElementBox& box) {
        sum += double(forest.tiles.levels()[tree].tiles[tile].size) *
               share(area.low_x, area.high_x, box.min[0], box.max[0]) *
               share(area.low_y, area.high_y, box.min[1], box.max[1]);
    });
    return sum / bytes_per_element;
}

double Geometry::Impl::tile_side() const
{
    const double area = (bounds.max.x() - bounds.min.x()) * (bounds.max.y() - bounds.min.y());
    return area > 0 ? std::sqrt(area * TileBoxes::most / double(elements)) : 0;
}

Geometry::Geometry() : impl_(std::make_shared<const Impl>()) {}

Geometry::Geometry(std::shared_ptr<const Impl> impl) : impl_(std::move(impl)) {}

std::uint64_t Geometry::element_count() const { return impl_->elements; }
const Bounds& Geometry::bounds() const { return impl_->bounds; }
const std::vector<Part>& Geometry::parts() const { return impl_->parts; }
bool Geometry::is_removed(std::size_t part) const { return !impl_->is_removed.empty() && impl_->is_removed[part] != 0; }
const std::vector<FaceGroup>& Geometry::face_groups() const { return impl_->face_groups; }
const LabelCounts& Geometry::labels() const { return impl_->labels; }

std::shared_ptr<const Forest> forest_of(const Scene& scene, const ElementNumbers& first, int threads)
{
    auto out = std::make_shared<Forest>();
    out->limits = {first.part + scene.parts.size(), first.group + scene.face_groups.size()};
    const std::size_t elements = element_count(scene);
    if (elements == 0) return out;
    std::vector<ElementBox> boxes(elements);
    parallel_for(elements, threads, {},
                 [&](std::size_t e) { boxes[e] = widened(element_bounds(scene, std::uint32_t(e))); });
    TileStoreBuilder store(0);
    for (std::vector<std::uint32_t>& group : groups_of(scene, boxes)) {
        const std::vector<std::uint32_t> order = packed_order(boxes, std::move(group), threads);
        std::vector<std::string> tiles((order.size() + TileBoxes::most - 1) / TileBoxes::most);
        std::vector<ElementBox> around(tiles.size());
        parallel_for(tiles.size(), threads, {}, [&](std::size_t t) {
            const std::size_t begin = t * TileBoxes::most;
            const auto in_tile = std::span(order).subspan(begin, std::min(TileBoxes::most, order.size() - begin));
            tiles[t] = tile_of(scene, boxes, in_tile, first);
            around[t] = box_around(boxes, in_tile);
        });
        TileLevel level(1, std::uint32_t(tiles.size()), 1, 1);
        store.add(std::move(level), std::move(tiles), threads);
        out->trees.emplace_back(std::move(around));
    }
    out->tiles = store.build();
    return out;
}

Geometry::Geometry(const Scene& scene, int threads)
{
    auto impl = std::make_shared<Impl>();
    impl->elements = spawnfield::element_count(scene);
    impl->parts = scene.parts;
    impl->face_groups = scene.face_groups;
    impl->labels = scene.count_labels();
    impl->has_filled_meshes = has_filled_meshes(scene);
    if (impl->elements > 0) impl->bounds = scene.bounds();
    impl->next = {std::uint32_t(impl->elements), std::uint32_t(scene.pieces.size()), std::uint32_t(scene.parts.size()),
                  std::uint32_t(scene.face_groups.size())};
    parallel_for(2, threads, {}, [&](std::size_t task) {
        if (task == 0)
            impl->forests = {forest_of(scene, {}, threads)};
        else
            impl->part_hashes = hashes_of_parts(scene, threads);
    });
    impl_ = std::move(impl);
}

}  // namespace spawnfield
