#include "geometry/changed_geometry.h"

#include "base/parallel.h"
#include "geometry/geometry_impl.h"
#include "scene/elements.h"

#include <spawnfield/error.h>

#include <limits>
#include <optional>

namespace spawnfield {
namespace {

/// What a tile loses, and what remains of it.
struct Loss {
    std::optional<ElementBox> removed;  ///< around the removed elements
    Bounds rest;                        ///< of all other elements
    LabelCounts labels{};               ///< of the removed elements
    bool has_filled_meshes = false;     ///< in what remains
};

void add_to(Bounds& bounds, const Bounds& more)
{
    if (more.is_empty()) return;
    bounds.extend(more.min);
    bounds.extend(more.max);
}

Loss loss_of(const Tile& tile, const std::vector<bool>& is_removed)
{
    Loss out;
    for_each_bit(tile.alive, [&](std::uint32_t element) {
        const bool is_triangle = tile.is_triangle(element);
        if (!is_removed[tile.part(element)]) {
            add_to(out.rest, is_triangle ? tile.bounds(element) : bounds_of(tile.primitive(element).shape()));
            out.has_filled_meshes |= is_triangle && tile.piece(element).solid != 0;
            return;
        }
        const ElementBox box = tile.box(element);
        if (out.removed)
            extend(*out.removed, box);
        else
            out.removed = box;
        LabelCount& count = out.labels[std::size_t(tile.label(element))];
        ++(is_triangle ? count.triangles : count.primitives);
    });
    return out;
}

/// Removes parts from `to`, which is still a copy of `base`. Appends boxes around their elements.
void remove(const Geometry::Impl& base, const std::vector<bool>& is_removed, int threads, Geometry::Impl& to,
            std::vector<ElementBox>& boxes)
{
    to.bounds = {};
    to.has_filled_meshes = false;
    base.expect_all();
    base.for_each_tree([&](const Forest& forest, std::size_t tree) {
        std::vector<Loss> losses(forest.trees[tree].boxes().size());
        parallel_for(losses.size(), threads, {},
                     [&](std::size_t t) { losses[t] = loss_of(base.open(forest, tree, t), is_removed); });
        for (const Loss& loss : losses) {
            if (loss.removed) boxes.push_back(*loss.removed);
            add_to(to.bounds, loss.rest);
            to.has_filled_meshes |= loss.has_filled_meshes;
            for (std::size_t label = 0; label < loss.labels.size(); ++label) {
                to.labels[label].triangles -= loss.labels[label].triangles;
                to.labels[label].primitives -= loss.labels[label].primitives;
                to.elements -= loss.labels[label].triangles + loss.labels[label].primitives;
            }
        }
    });
    to.is_removed.resize(to.parts.size());
    for (std::size_t part = 0; part < to.parts.size(); ++part) {
        if (!is_removed[part]) continue;
        to.is_removed[part] = 1;
        to.parts[part] = {.name = to.parts[part].name, .kind = to.parts[part].kind, .label = to.parts[part].label};
    }
}

void add(const Scene& scene, int threads, Geometry::Impl& to, std::vector<ElementBox>& boxes)
{
    constexpr std::uint64_t most = std::numeric_limits<std::uint32_t>::max();
    if (to.next.element + element_count(scene) > most)
        throw ArgumentError("with_changes", "the map and the added parts have more than 4 billion elements");
    const auto forest = forest_of(scene, to.next, threads);
    for (const TileTree& tree : forest->trees) boxes.insert(boxes.end(), tree.boxes().begin(), tree.boxes().end());
    to.forests.push_back(forest);
    to.elements += element_count(scene);
    add_to(to.bounds, scene.bounds());
    to.parts.insert(to.parts.end(), scene.parts.begin(), scene.parts.end());
    for (FaceGroup group : scene.face_groups) {
        group.part += to.next.part;
        to.face_groups.push_back(std::move(group));
    }
    const LabelCounts labels = scene.count_labels();
    for (std::size_t label = 0; label < labels.size(); ++label) {
        to.labels[label].triangles += labels[label].triangles;
        to.labels[label].primitives += labels[label].primitives;
    }
    to.has_filled_meshes |= has_filled_meshes(scene);
    to.next = {to.next.element + std::uint32_t(element_count(scene)),
               to.next.piece + std::uint32_t(scene.pieces.size()), std::uint32_t(to.parts.size()),
               std::uint32_t(to.face_groups.size())};
    if (!to.is_removed.empty()) to.is_removed.resize(to.parts.size());
}

std::uint64_t terrain_elements(const LabelCounts& labels)
{
    const LabelCount& count = labels[std::size_t(Label::Terrain)];
    return count.triangles + count.primitives;
}

}  // namespace

ChangedGeometry changed_geometry(const Geometry& base, const std::vector<bool>& is_removed, const Scene& added,
                                 int threads)
{
    ChangedGeometry out;
    auto impl = std::make_shared<Geometry::Impl>(base.impl());
    impl->part_hashes.clear();
    if (std::find(is_removed.begin(), is_removed.end(), true) != is_removed.end())
        remove(base.impl(), is_removed, threads, *impl, out.boxes);
    out.changes_terrain = terrain_elements(impl->labels) != terrain_elements(base.labels()) || added.has_terrain();
    if (!added.parts.empty()) add(added, threads, *impl, out.boxes);
    out.geometry = Geometry(std::move(impl));
    return out;
}

}  // namespace spawnfield
