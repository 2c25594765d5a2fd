#pragma once

#include <spawnfield/shape.h>

#include <algorithm>
#include <vector>

namespace spawnfield {

/// Sorts items from the bottom up, and joins those whose intervals overlap or lie within `tolerance` (m) of each other.
/// z_of(item) returns a reference to the Interval of an item. When `next` is joined to `item`, which begins at the same
/// height or lower, merge(item, next) updates the other fields of `item`. It sees the old intervals; after it, the top
/// of `item` becomes the larger top.
template <class Item, class ZOf, class Merge>
void join_intervals(std::vector<Item>& items, double tolerance, const ZOf& z_of, const Merge& merge)
{
    std::sort(items.begin(), items.end(),
              [&](const Item& l, const Item& r) { return z_of(l).bottom < z_of(r).bottom; });
    std::size_t kept = 0;
    for (const Item& next : items) {
        if (kept == 0 || z_of(next).bottom > z_of(items[kept - 1]).top + tolerance) {
            items[kept++] = next;
            continue;
        }
        Item& item = items[kept - 1];
        merge(item, next);
        z_of(item).top = std::max(z_of(item).top, z_of(next).top);
    }
    items.resize(kept);
}

/// Sorts intervals from the bottom up, and joins those that overlap or lie within `tolerance` (m) of each other.
inline void join_intervals(std::vector<Interval>& intervals, double tolerance)
{
    const auto itself = [](auto& interval) -> auto& { return interval; };
    join_intervals(intervals, tolerance, itself, [](Interval&, const Interval&) {});
}

}  // namespace spawnfield
