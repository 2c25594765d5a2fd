#include "column/column_builder.h"

#include "base/intervals.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <tuple>

namespace spawnfield {
namespace {

void add(const Interval& z, const SurfaceHit& hit, bool terrain, Column& out)
{
    if (hit.water) {
        out.water.push_back(z.top);
        return;
    }
    Span& span = out.spans.emplace_back();  // set in place: copying it would wait for all of its parts
    span.bottom = z.bottom;
    span.top = z.top;
    span.terrain = terrain;
    span.sealed = !hit.open;
    span.part = hit.part;
}

}  // namespace

void ColumnBuilder::build(std::span<const SurfaceHit> hits, Column& out, std::span<const Span> sheets,
                          std::span<const double> water_sheets)
{
    const std::size_t first_span = out.spans.size(), first_water = out.water.size();
    out.spans.insert(out.spans.end(), sheets.begin(), sheets.end());
    out.water.insert(out.water.end(), water_sheets.begin(), water_sheets.end());
    for (std::size_t i = 0; i < hits.size();) {
        const SurfaceHit& hit = hits[i];
        if (hit.is_primitive || !hit.filled) {
            add(hit.z, hit, hit.terrain, out);
            ++i;
            continue;
        }
        std::size_t end = i;
        while (end < hits.size() && !hits[end].is_primitive && hits[end].piece == hit.piece) ++end;
        add_piece(hits.subspan(i, end - i), out);
        i = end;
    }
    finish(first_span, first_water, out);
}

/// Adds a filled piece. It consists entirely of water or has no water.
void ColumnBuilder::add_piece(std::span<const SurfaceHit> hits, Column& out)
{
    const auto only_crosses = [](const SurfaceHit& hit) { return hit.crosses && !hit.touches; };
    if (hits.size() == 2 && only_crosses(hits[0]) && only_crosses(hits[1])) {  // most lines: in, and out again
        const bool is_upwards = hits[0].crossing <= hits[1].crossing;
        const SurfaceHit &low = hits[is_upwards ? 0 : 1], &high = hits[is_upwards ? 1 : 0];
        add({low.crossing, high.crossing}, hits[0], high.terrain, out);
        return;
    }
    intervals_.clear();
    crossings_.clear();
    for (const SurfaceHit& hit : hits) {
        if (hit.crosses) crossings_.push_back({{hit.crossing, hit.crossing}, hit.terrain});
        if (hit.touches) intervals_.push_back({hit.z, hit.terrain});
    }
    pair_crossings(crossings_, hits.front().piece_bottom, intervals_);
    join(intervals_);
    for (const Solid& solid : intervals_) add(solid.z, hits.front(), solid.terrain, out);
}

/// Completes a column whose spans and water were appended to `out`, unsorted, from these places on: sorts them from the
/// top down, drops duplicates, and adds the layers.
void ColumnBuilder::finish(std::size_t first_span, std::size_t first_water, Column& out)
{
    const auto first = out.spans.begin() + std::ptrdiff_t(first_span);
    if (out.spans.end() - first > 1) {
        std::sort(first, out.spans.end(), [](const Span& l, const Span& r) {
            if (l.top != r.top) return l.top > r.top;
            if (l.terrain != r.terrain) return l.terrain;
            return std::tie(l.part, l.bottom, l.sealed) < std::tie(r.part, r.bottom, r.sealed);
        });
        // A line through a corner or an edge of a sheet hits several of its triangles.
        out.spans.erase(std::unique(first, out.spans.end()), out.spans.end());
    }
    if (out.water.size() - first_water > 1) {
        std::sort(out.water.begin() + std::ptrdiff_t(first_water), out.water.end(), std::greater<>());
        out.water.erase(std::unique(out.water.begin() + std::ptrdiff_t(first_water), out.water.end()), out.water.end());
    }
    // Terrain that overlaps, or is closer than layer_tolerance, is one layer. The highest top comes first.
    double lowest = std::numeric_limits<double>::infinity();  // of the last layer's terrain, m
    for (const Span& span : std::span(out.spans).subspan(first_span)) {
        if (!span.terrain) continue;
        if (lowest <= span.top + layer_tolerance) {
            lowest = std::min(lowest, span.bottom);
        } else {
            out.layers.push_back(span.top);
            lowest = span.bottom;
        }
    }
}

/// Adds the intervals inside a filled piece, from the bottom up: its crossings in pairs. The number of crossings is odd
/// only in a piece with holes that the user asked to fill; there the column is inside from the lowest crossing down to
/// the piece's bottom.
void ColumnBuilder::pair_crossings(std::vector<Solid>& crossings, double piece_bottom, std::vector<Solid>& intervals)
{
    std::sort(crossings.begin(), crossings.end(), [](const Solid& l, const Solid& r) { return l.z.top < r.z.top; });
    std::size_t i = 0;
    if (crossings.size() % 2 == 1) {
        const Solid& lowest = crossings[i++];
        intervals.push_back({{std::min(piece_bottom, lowest.z.top), lowest.z.top}, lowest.terrain});
    }
    for (; i < crossings.size(); i += 2)
        intervals.push_back({{crossings[i].z.top, crossings[i + 1].z.top}, crossings[i + 1].terrain});
}

/// Joins intervals that overlap or lie within touch_tolerance of each other. The highest top gives the height and the
/// label of the joined interval.
void ColumnBuilder::join(std::vector<Solid>& intervals)
{
    if (intervals.size() < 2) return;
    const auto z_of = [](auto& solid) -> auto& { return solid.z; };
    join_intervals(intervals, touch_tolerance, z_of, [](Solid& solid, const Solid& next) {
        const bool same_top = std::abs(next.z.top - solid.z.top) <= touch_tolerance;
        if (same_top)
            solid.terrain = solid.terrain || next.terrain;
        else if (next.z.top > solid.z.top)
            solid.terrain = next.terrain;
    });
}

}  // namespace spawnfield
