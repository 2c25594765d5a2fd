#include "audit/props.h"
#include "base/parallel.h"
#include "column/columns.h"

#include <algorithm>
#include <map>
#include <optional>

namespace spawnfield {
namespace {

constexpr int lines_along_side = 16;
constexpr std::size_t most_middles = 256;
constexpr double flat = 1e-9;  // m: a prop that is not higher on its lines has no length there

/// What vertical lines say about a prop.
struct Depth {
    double length = 0, below = 0;  ///< m: of the prop, and of it below the ground
    double top = -std::numeric_limits<double>::infinity();
    std::size_t lines = 0, lines_below = 0;
};

/// Returns the length of an interval that is below the lowest layer, or inside a solid of terrain, m.
double length_below(const Interval& prop, const Column& column)
{
    std::vector<Interval> ground;
    if (!column.layers.empty()) ground.push_back({-std::numeric_limits<double>::infinity(), column.layers.back()});
    for (const Span& span : column.spans)
        if (span.terrain) ground.push_back({span.bottom, span.top});
    std::sort(ground.begin(), ground.end(), [](const Interval& a, const Interval& b) { return a.bottom < b.bottom; });
    double out = 0, counted_to = prop.bottom;
    for (const Interval& interval : ground) {
        const double from = std::max(interval.bottom, counted_to), to = std::min(interval.top, prop.top);
        out += std::max(0.0, to - from);
        counted_to = std::max(counted_to, to);
    }
    return out;
}

/// Returns the interval from the lowest to the highest point of a prop on a line.
std::optional<Interval> interval_of(std::uint32_t prop, const Props& props, const Column& column)
{
    std::optional<Interval> out;
    for (const Span& span : column.spans) {
        if (props.of[span.part] != prop) continue;
        if (!out) out = Interval{span.bottom, span.top};
        out->bottom = std::min(out->bottom, span.bottom);
        out->top = std::max(out->top, span.top);
    }
    return out;
}

void add_line(Depth& depth, std::uint32_t prop, const Props& props, const Geometry& geometry, double x, double y,
              Column& column)
{
    read_column(geometry, x, y, column);
    const std::optional<Interval> line = interval_of(prop, props, column);
    if (!line) return;
    ++depth.lines;
    depth.top = std::max(depth.top, line->top);
    depth.length += line->top - line->bottom;
    depth.below += length_below(*line, column);
    if (!column.layers.empty() && line->top < column.layers.back()) ++depth.lines_below;
}

Depth depth_of(std::uint32_t prop, const std::vector<Vec3>& middles, const Props& props, const Geometry& geometry)
{
    Depth out;
    Column column;
    const Bounds& box = props.all[prop].bounds;
    const auto line = [&](int axis, int k) {
        return box.min[axis] + (k + 0.5) / lines_along_side * (box.max[axis] - box.min[axis]);
    };
    for (int row = 0; row < lines_along_side; ++row)
        for (int col = 0; col < lines_along_side; ++col)
            add_line(out, prop, props, geometry, line(0, col), line(1, row), column);
    if (out.lines > 0) return out;
    const std::size_t step = (middles.size() + most_middles - 1) / most_middles;
    for (std::size_t i = 0; i < middles.size(); i += step)
        add_line(out, prop, props, geometry, middles[i].x(), middles[i].y(), column);
    return out;
}

/// Returns the middles of the bounding boxes of each prop's elements.
std::vector<std::vector<Vec3>> middles_of(const Geometry& geometry, const Props& props)
{
    std::vector<std::vector<Vec3>> out(props.all.size());
    for (const PropElement& at : props.elements) {
        const Tile tile = geometry.impl().open(*at.forest, at.tree, at.tile);
        const Bounds box = tile.bounds(at.element);
        if (!tile.is_triangle(at.element)) {
            out[at.prop].push_back((box.min + box.max) / 2);
            continue;
        }
        const auto [a, b, c] = tile.corners(at.element);
        out[at.prop].push_back((a + b + c) / 3);
    }
    return out;
}

}  // namespace

std::vector<SunkenProp> find_sunken(const Geometry& geometry, const Props& props, int threads)
{
    constexpr double most = 0.5 + 1e-6;  // a ball whose middle is on the ground is not mostly below it
    const std::vector<std::vector<Vec3>> middles = middles_of(geometry, props);
    std::vector<std::optional<SunkenProp>> found(props.all.size());
    parallel_for(found.size(), threads, {}, [&](std::size_t p) {
        const Prop& prop = props.all[p];
        if (!prop.is_examined()) return;
        const Depth depth = depth_of(std::uint32_t(p), middles[p], props, geometry);
        if (depth.lines == 0) return;
        const double share = depth.length > flat * double(depth.lines)
                                 ? depth.below / depth.length
                                 : double(depth.lines_below) / double(depth.lines);
        if (share > most)
            found[p] = SunkenProp{prop.name, share, depth.top, depth.lines, (prop.bounds.min + prop.bounds.max) / 2};
    });
    std::vector<SunkenProp> out;
    for (std::optional<SunkenProp>& sunken : found)
        if (sunken) out.push_back(std::move(*sunken));
    return out;
}

}  // namespace spawnfield
