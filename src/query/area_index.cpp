#include "query/area_index.h"

#include <spawnfield/shape.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace spawnfield {
namespace {

constexpr double on_edge = 1e-9;    // m
constexpr double near_edge = 2e-9;  // m; points farther from an edge are certainly on one side of it

double squared_distance(const Vec2& p, const Vec2& from, const Vec2& to)
{
    const Vec2 along = to - from, off = p - from;
    const double length = along.squaredNorm(), t = length > 0 ? std::clamp(off.dot(along) / length, 0.0, 1.0) : 0;
    return (off - t * along).squaredNorm();
}

/// Calls visit(number of the polygon, start, end) for each edge, polygon after polygon.
template <class Visit>
void for_each_edge(const std::vector<Region>& regions, const Visit& visit)
{
    std::uint32_t number = 0;
    for (const Region& region : regions)
        for (const Region::Polygon& polygon : region.polygons) {
            for (const Region::Ring& ring : polygon)
                for (std::size_t i = 0; i < ring.size(); ++i)
                    visit(number, ring[i], ring[i + 1 < ring.size() ? i + 1 : 0]);
            ++number;
        }
}

}  // namespace

PolygonIndex::PolygonIndex(const std::vector<Region>& regions)
{
    double low = std::numeric_limits<double>::infinity(), high = -low;
    std::size_t count = 0;
    for_each_edge(regions, [&](std::uint32_t, const Vec2& from, const Vec2&) {
        low = std::min(low, from.y());
        high = std::max(high, from.y());
        ++count;
    });
    if (count == 0) return;
    y0_ = low - near_edge;
    end_ = high + near_edge;
    // A long vertical edge lies in many rows. If there are too many entries, the number of rows is halved.
    std::size_t rows = std::min<std::size_t>(count, 8192), entries = 0;
    for (;; rows /= 2) {
        height_ = (end_ - y0_) / double(rows);
        entries = 0;
        for_each_edge(regions, [&](std::uint32_t, const Vec2& from, const Vec2& to) {
            entries += row_of(std::max(from.y(), to.y()) + near_edge) - row_of(std::min(from.y(), to.y()) - near_edge) +
                       1;
        });
        if (rows < 2 || entries <= 16 * count + 65536) break;
    }
    struct Entry {
        std::uint32_t row, polygon;
        Edge edge;
    };
    std::vector<Entry> all;
    all.reserve(entries);
    for_each_edge(regions, [&](std::uint32_t polygon, const Vec2& from, const Vec2& to) {
        const std::size_t last = row_of(std::max(from.y(), to.y()) + near_edge);
        for (std::size_t row = row_of(std::min(from.y(), to.y()) - near_edge); row <= last; ++row)
            all.push_back({std::uint32_t(row), polygon, {from, to}});
    });
    std::stable_sort(all.begin(), all.end(), [](const Entry& a, const Entry& b) { return a.row < b.row; });
    starts_.assign(rows + 1, 0);
    for (std::size_t i = 0; i < all.size(); ++i) {
        const Entry& entry = all[i];
        if (i == 0 || entry.row != all[i - 1].row || entry.polygon != all[i - 1].polygon) {
            constexpr double far = std::numeric_limits<double>::infinity();
            groups_.push_back({entry.polygon, std::uint32_t(i), std::uint32_t(i), far, -far});
            ++starts_[entry.row + 1];
        }
        Group& group = groups_.back();
        group.last = std::uint32_t(i + 1);
        group.low_x = std::min({group.low_x, entry.edge.from.x(), entry.edge.to.x()});
        group.high_x = std::max({group.high_x, entry.edge.from.x(), entry.edge.to.x()});
        edges_.push_back(entry.edge);
    }
    for (std::size_t row = 0; row < rows; ++row) starts_[row + 1] += starts_[row];
}

std::size_t PolygonIndex::row_of(double y) const
{
    const double rows = std::max(1.0, std::round((end_ - y0_) / height_));
    return std::size_t(std::clamp((y - y0_) / height_, 0.0, rows - 1));
}

bool PolygonIndex::holds(const Group& group, const Vec2& p) const
{
    if (p.x() < group.low_x - on_edge || p.x() > group.high_x + on_edge)
        return false;  // to the left or right of all its edges
    bool inside = false;
    for (std::uint32_t i = group.first; i < group.last; ++i) {
        const Vec2 &a = edges_[i].from, &b = edges_[i].to;
        if (squared_distance(p, a, b) <= on_edge * on_edge) return true;
        if ((a.y() <= p.y()) == (b.y() <= p.y())) continue;
        const double side = cross(b - a, p - a);  // > 0: left of the edge
        if ((a.y() < b.y()) == (side > 0)) inside = !inside;
    }
    return inside;
}

bool PolygonIndex::contains(const Vec2& point) const
{
    if (starts_.empty() || !(point.y() >= y0_ && point.y() <= end_)) return false;
    const std::size_t row = row_of(point.y());
    for (std::uint32_t g = starts_[row]; g < starts_[row + 1]; ++g)
        if (holds(groups_[g], point)) return true;
    return false;
}

bool PolygonIndex::meets(const Group& group, const Rect& rect) const
{
    const double low_x = rect.low_x - near_edge, high_x = rect.high_x + near_edge, low_y = rect.low_y - near_edge,
                 high_y = rect.high_y + near_edge;
    if (group.high_x < low_x || group.low_x > high_x) return false;
    for (std::uint32_t i = group.first; i < group.last; ++i) {
        const Vec2 &a = edges_[i].from, &b = edges_[i].to;
        if (std::max(a.x(), b.x()) < low_x || std::min(a.x(), b.x()) > high_x || std::max(a.y(), b.y()) < low_y ||
            std::min(a.y(), b.y()) > high_y)
            continue;
        const Vec2 along = b - a;
        const double slack = near_edge * along.lpNorm<1>();
        const auto side = [&](double x, double y) { return cross(along, Vec2(x, y) - a); };
        const auto [least, most] = std::minmax(
            {side(low_x, low_y), side(high_x, low_y), side(low_x, high_y), side(high_x, high_y)});
        if (least <= slack && most >= -slack) return true;
    }
    return false;
}

bool PolygonIndex::misses(const Rect& rect) const
{
    if (starts_.empty() || rect.high_y < y0_ || rect.low_y > end_) return true;
    const std::size_t last = row_of(rect.high_y + near_edge);
    for (std::size_t row = row_of(rect.low_y - near_edge); row <= last; ++row)
        for (std::uint32_t g = starts_[row]; g < starts_[row + 1]; ++g)
            if (meets(groups_[g], rect)) return false;
    return !contains({rect.centre_x(), rect.centre_y()});
}

bool PolygonIndex::covers(const Rect& rect) const
{
    if (starts_.empty() || rect.low_y < y0_ || rect.high_y > end_) return false;
    const Vec2 centre(rect.centre_x(), rect.centre_y());
    const std::size_t first = row_of(rect.low_y - near_edge), last = row_of(rect.high_y + near_edge),
                      middle = row_of(centre.y());
    const auto is_whole = [&](std::uint32_t polygon) {
        for (std::size_t row = first; row <= last; ++row)
            for (std::uint32_t g = starts_[row]; g < starts_[row + 1]; ++g)
                if (groups_[g].polygon == polygon && meets(groups_[g], rect)) return false;
        return true;
    };
    for (std::uint32_t g = starts_[middle]; g < starts_[middle + 1]; ++g)
        if (holds(groups_[g], centre) && is_whole(groups_[g].polygon)) return true;
    return false;
}

AreaIndex::AreaIndex(const Area& area) : within_(slabs_of(area.within)), keep_out_(slabs_of(area.keep_out)) {}

std::vector<AreaIndex::Slab> AreaIndex::slabs_of(const std::vector<Region>& regions)
{
    std::vector<std::pair<ZRange, std::vector<Region>>> groups;
    for (const Region& region : regions) {
        auto group = std::find_if(groups.begin(), groups.end(), [&](const auto& g) { return g.first == region.z; });
        if (group == groups.end()) group = groups.insert(group, {region.z, {}});
        group->second.push_back(region);
    }
    std::vector<Slab> out;
    for (const auto& [z, members] : groups) out.push_back({z, PolygonIndex(members)});
    return out;
}

bool AreaIndex::contains(const Vec2& point) const
{
    const auto has = [&](const Slab& slab) { return slab.polygons.contains(point); };
    return (within_.empty() || std::any_of(within_.begin(), within_.end(), has)) &&
           std::none_of(keep_out_.begin(), keep_out_.end(),
                        [&](const Slab& slab) { return slab.z.is_unlimited() && has(slab); });
}

bool AreaIndex::contains(const Vec2& point, double z) const
{
    const auto has = [&](const Slab& slab) {
        return slab.z.contains(z, touch_tolerance) && slab.polygons.contains(point);
    };
    return (within_.empty() || std::any_of(within_.begin(), within_.end(), has)) &&
           std::none_of(keep_out_.begin(), keep_out_.end(), has);
}

bool AreaIndex::misses(const Rect& rect, const ZRange& z) const
{
    const auto is_apart = [&](const Slab& slab) {
        return slab.z.low > z.high + 2 * touch_tolerance || slab.z.high < z.low - 2 * touch_tolerance ||
               slab.polygons.misses(rect);
    };
    const auto holds_all = [&](const Slab& slab) {
        return slab.z.low <= z.low && slab.z.high >= z.high && slab.polygons.covers(rect);
    };
    return (!within_.empty() && std::all_of(within_.begin(), within_.end(), is_apart)) ||
           std::any_of(keep_out_.begin(), keep_out_.end(), holds_all);
}

}  // namespace spawnfield
