#include "column/column_builder.h"
#include "column/columns.h"

#include <algorithm>

namespace spawnfield {

std::uint64_t counted(const Tile& tile, std::uint64_t elements, Surfaces surfaces)
{
    if (surfaces == Surfaces::All) return elements;
    std::uint64_t out = 0;
    for_each_bit(elements, [&](std::uint32_t element) {
        const bool counts = !tile.is_triangle(element) || tile.piece(element).solid != 0;
        out |= std::uint64_t{counts} << element;
    });
    return out;
}

void find_hits(const Geometry& geometry, double x, double y, Surfaces surfaces, std::vector<SurfaceHit>& hits)
{
    hits.clear();
    geometry.impl().visit_tiles(Rect{x, y, x, y}, [&](const Tile& tile, const ElementBox&) {
        for_each_bit(counted(tile, tile.near(x, y), surfaces), [&](std::uint32_t element) {
            if (const auto hit = hit_of(tile, element, x, y)) hits.push_back(*hit);
        });
    });
    std::sort(hits.begin(), hits.end(), [](const SurfaceHit& l, const SurfaceHit& r) { return l.element < r.element; });
}

void read_column(const Geometry& geometry, double x, double y, Column& out)
{
    struct Memory {
        std::vector<SurfaceHit> hits;
        ColumnBuilder builder;
    };
    thread_local Memory memory;
    find_hits(geometry, x, y, Surfaces::All, memory.hits);
    out.spans.clear();
    out.layers.clear();
    out.water.clear();
    memory.builder.build(memory.hits, out);
}

Column column_at(const Geometry& geometry, double x, double y)
{
    Column out;
    read_column(geometry, x, y, out);
    return out;
}

std::optional<Ground> ground_below(const Column& column, double z) { return ground_below(ColumnView(column), z); }

}  // namespace spawnfield
