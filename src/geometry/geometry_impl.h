#pragma once

#include "base/bits.h"
#include "base/tile_store.h"
#include "geometry/tile_tree.h"

#include <spawnfield/geometry.h>

namespace spawnfield {

struct Geometry::Impl {
    std::uint64_t elements = 0;
    Bounds bounds;            ///< of all elements
    std::vector<Part> parts;  ///< of the scene, in its order
    LabelCounts labels{};
    bool has_filled_meshes = false;

    /// Gives the geometry its tiles. Each level of the store has the tiles of one tree.
    void set_tiles(TileStore tiles, std::vector<TileTree> trees);
    const TileStore& tiles() const { return tiles_; }
    const std::vector<TileTree>& trees() const { return trees_; }

    /// Returns a tile. Throws FileError for a damaged tile of a file.
    Tile open(std::size_t tree, std::size_t tile) const { return Tile(bytes_of(tree, tile)); }

    /// Calls visit(tile, element) once for each element whose box meets the closed rectangle.
    template <class Visit>
    void visit_in(double low_x, double low_y, double high_x, double high_y, const Visit& visit) const
    {
        visit_near(low_x, low_y, high_x, high_y, [&](const Tile& tile, std::uint32_t element) {
            const ElementBox box = tile.box(element);
            if (box.min[0] <= high_x && box.max[0] >= low_x && box.min[1] <= high_y && box.max[1] >= low_y)
                visit(tile, element);
        });
    }

    /// Calls visit(tile, box) for each tile whose box meets the closed rectangle, and for a few others near it.
    template <class Visit>
    void visit_tiles(double low_x, double low_y, double high_x, double high_y, const Visit& visit) const
    {
        for (std::size_t t = 0; t < trees_.size(); ++t)
            trees_[t].visit(low_x, low_y, high_x, high_y,
                            [&](std::size_t number) { visit(open(t, number), trees_[t].boxes()[number]); });
    }

    /// The same for a closed box.
    template <class Visit>
    void visit_tiles(const Bounds& space, const Visit& visit) const
    {
        for (std::size_t t = 0; t < trees_.size(); ++t)
            trees_[t].visit(space, [&](std::size_t number) { visit(open(t, number), trees_[t].boxes()[number]); });
    }

    /// Does the same as visit_tiles, for callers that read most of each tile: while a tile is visited, the processor
    /// already fetches the next one from memory.
    template <class Visit>
    void visit_whole_tiles(double low_x, double low_y, double high_x, double high_y, const Visit& visit) const
    {
        constexpr std::size_t line = 64, none = std::size_t(-1);  // bytes of a cache line; no tile
        for (std::size_t t = 0; t < trees_.size(); ++t) {
            std::size_t next = none;
            const auto visit_next = [&] {
                if (next != none) visit(open(t, next), trees_[t].boxes()[next]);
            };
            trees_[t].visit(low_x, low_y, high_x, high_y, [&](std::size_t number) {
                const std::string_view bytes = bytes_of(t, number);
                for (std::size_t at = 0; at < bytes.size(); at += line) __builtin_prefetch(bytes.data() + at);
                visit_next();
                next = number;
            });
            visit_next();
        }
    }

    /// Calls visit(tile, element) once for each element whose box meets the closed rectangle, and for a few others near
    /// it.
    template <class Visit>
    void visit_near(double low_x, double low_y, double high_x, double high_y, const Visit& visit) const
    {
        visit_tiles(low_x, low_y, high_x, high_y, [&](const Tile& tile, const ElementBox&) {
            for_each_bit(tile.near(low_x, low_y, high_x, high_y), [&](std::uint32_t element) { visit(tile, element); });
        });
    }

    /// Estimates how many elements lie in a rectangle, from the sizes of the tiles that it meets. Each tile counts by
    /// the share of its area in the rectangle.
    double elements_near(double low_x, double low_y, double high_x, double high_y) const;

private:
    std::string_view bytes_of(std::size_t tree, std::size_t tile) const
    {
        return tiles_.open(tree, tile,
                           [this](std::string_view bytes) { return is_consistent_tile(bytes, parts.size()); });
    }

    TileStore tiles_;
    std::vector<TileTree> trees_;
};

}  // namespace spawnfield
