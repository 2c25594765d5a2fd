#pragma once

#include "base/bits.h"
#include "base/tile_store.h"
#include "geometry/tile_tree.h"

#include <spawnfield/geometry.h>

#include <memory>

namespace spawnfield {

/// Tiles with the trees that find them. Level k of the store has the tiles of tree k.
struct Forest {
    TileStore tiles;
    std::vector<TileTree> trees;
    TileLimits limits;  ///< of the numbers in the tiles

    /// Returns the bytes of a tile. Throws FileError for a damaged tile of a file.
    std::string_view bytes_of(std::size_t tree, std::size_t tile) const
    {
        return tiles.open(tree, tile, [this](std::string_view bytes) { return is_consistent_tile(bytes, limits); });
    }
};

/// A scene has one forest. A changed one (changed_geometry.h) has the forest of the unchanged scene, and one for each
/// time that parts were added.
struct Geometry::Impl {
    std::uint64_t elements = 0;  ///< without those of removed parts
    Bounds bounds;               ///< of all elements
    /// Of the scene, in its order. Removed parts keep their place, with all counts 0; added parts follow.
    std::vector<Part> parts;
    std::vector<FaceGroup> face_groups;  ///< see Geometry::face_groups()
    LabelCounts labels{};
    std::vector<std::uint64_t> part_hashes;  ///< for each part; empty for a changed scene or an old map
    bool has_filled_meshes = false;
    std::vector<std::shared_ptr<const Forest>> forests;
    ElementNumbers next;                   ///< all numbers in the tiles are below these
    std::vector<std::uint8_t> is_removed;  ///< for each part; empty if no part was removed

    /// Says that most tiles will be needed (see TileStore).
    void expect_all() const
    {
        for (const auto& forest : forests) forest->tiles.expect_all();
    }

    /// Returns a tile, in which elements of removed parts are not alive. Throws FileError for a damaged tile of a file.
    Tile open(const Forest& forest, std::size_t tree, std::size_t tile) const
    {
        return alive(Tile(forest.bytes_of(tree, tile)));
    }

    /// Calls visit(forest, tree, tile, box) for each tile whose box meets a closed Rect or Bounds, and for a few others
    /// near it, without opening it.
    template <class Space, class Visit>
    void find_tiles(const Space& space, const Visit& visit) const
    {
        for_each_tree([&](const Forest& forest, std::size_t t) {
            const TileTree& tree = forest.trees[t];
            tree.visit(space, [&](std::size_t tile) { visit(forest, t, tile, tree.boxes()[tile]); });
        });
    }

    /// Calls visit(tile, box) for each of these tiles.
    template <class Space, class Visit>
    void visit_tiles(const Space& space, const Visit& visit) const
    {
        find_tiles(space, [&](const Forest& forest, std::size_t tree, std::size_t tile, const ElementBox& box) {
            visit(open(forest, tree, tile), box);
        });
    }

    /// Calls visit(tile, element) once for each element whose box meets the closed rectangle.
    template <class Visit>
    void visit_in(const Rect& area, const Visit& visit) const
    {
        visit_tiles(area, [&](const Tile& tile, const ElementBox&) {
            for_each_bit(tile.near(area), [&](std::uint32_t element) {
                const ElementBox box = tile.box(element);
                if (box.min[0] <= area.high_x && box.max[0] >= area.low_x && box.min[1] <= area.high_y &&
                    box.max[1] >= area.low_y)
                    visit(tile, element);
            });
        });
    }

    /// Does the same as visit_tiles, for callers that read most of each tile: while a tile is visited, the processor
    /// already fetches the next one from memory.
    template <class Visit>
    void visit_whole_tiles(const Rect& area, const Visit& visit) const
    {
        constexpr std::size_t line = 64, none = std::size_t(-1);  // bytes of a cache line; no tile
        for_each_tree([&](const Forest& forest, std::size_t t) {
            const TileTree& tree = forest.trees[t];
            std::size_t next_tile = none;
            const auto visit_next = [&] {
                if (next_tile != none) visit(open(forest, t, next_tile), tree.boxes()[next_tile]);
            };
            tree.visit(area, [&](std::size_t number) {
                const std::string_view bytes = forest.bytes_of(t, number);
                for (std::size_t at = 0; at < bytes.size(); at += line) __builtin_prefetch(bytes.data() + at);
                visit_next();
                next_tile = number;
            });
            visit_next();
        });
    }

    /// Estimates how many elements lie in a rectangle, from the sizes of the tiles that it meets. Each tile counts by
    /// the share of its area in the rectangle.
    double elements_near(const Rect& area) const;

    /// Returns the side of a square that has as many elements as a tile, if they are spread evenly, m.
    double tile_side() const;

    /// Calls visit(forest, tree) for each tree of each forest.
    template <class Visit>
    void for_each_tree(const Visit& visit) const
    {
        for (const auto& forest : forests)
            for (std::size_t t = 0; t < forest->trees.size(); ++t) visit(*forest, t);
    }

private:
    Tile alive(Tile tile) const
    {
        if (!is_removed.empty()) tile.keep([this](std::uint32_t part) { return is_removed[part] == 0; });
        return tile;
    }
};

/// Returns the tiles of a scene's elements. Their numbers begin at `first`.
std::shared_ptr<const Forest> forest_of(const Scene& scene, const ElementNumbers& first, int threads);

}  // namespace spawnfield
