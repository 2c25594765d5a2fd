#include "geometry/tile_tree.h"

#include "base/parallel.h"

#include <limits>

namespace spawnfield {
namespace {

constexpr float no_limit = std::numeric_limits<float>::infinity(),
                not_a_number = std::numeric_limits<float>::quiet_NaN();

ElementBox empty_box() { return {{no_limit, no_limit, no_limit}, {-no_limit, -no_limit, -no_limit}}; }

/// Twice the centre of a box along an axis.
double centre(const ElementBox& box, std::size_t axis) { return double(box.min[axis]) + double(box.max[axis]); }

struct Range {
    std::size_t first, end;
    std::size_t tiles() const { return (end - first + TileBoxes::most - 1) / TileBoxes::most; }
};

/// Splits a range of elements along the longest side of what their centres cover. The first part gets a power of two of
/// full tiles, so that 16 consecutive tiles are whole parts.
std::array<Range, 2> split(const std::vector<ElementBox>& boxes, std::vector<std::uint32_t>& order, const Range& range)
{
    std::array<double, 3> low, high;
    low.fill(std::numeric_limits<double>::infinity());
    high.fill(-std::numeric_limits<double>::infinity());
    for (std::size_t k = range.first; k < range.end; ++k)
        for (std::size_t axis = 0; axis < 3; ++axis) {
            low[axis] = std::min(low[axis], centre(boxes[order[k]], axis));
            high[axis] = std::max(high[axis], centre(boxes[order[k]], axis));
        }
    std::size_t longest = 0;
    for (const std::size_t axis : {1, 2})
        if (high[axis] - low[axis] > high[longest] - low[longest]) longest = axis;
    // Pairs beside each other are sorted faster than elements whose boxes are far apart in memory.
    std::vector<std::pair<double, std::uint32_t>> by_centre(range.end - range.first);
    for (std::size_t k = range.first; k < range.end; ++k)
        by_centre[k - range.first] = {centre(boxes[order[k]], longest), order[k]};
    const std::size_t middle = range.first + std::bit_ceil(range.tiles()) / 2 * TileBoxes::most;
    std::nth_element(by_centre.begin(), by_centre.begin() + std::ptrdiff_t(middle - range.first), by_centre.end());
    for (std::size_t k = range.first; k < range.end; ++k) order[k] = by_centre[k - range.first].second;
    return {Range{range.first, middle}, Range{middle, range.end}};
}

}  // namespace

TileTree::TileTree(std::vector<ElementBox> boxes) : boxes_(std::move(boxes))
{
    std::vector<ElementBox> children = boxes_;
    while (levels_.empty() ? !children.empty() : children.size() > 1) {
        std::vector<Node> nodes((children.size() + width - 1) / width);
        std::vector<ElementBox> around(nodes.size(), empty_box());
        for (std::size_t n = 0; n < nodes.size(); ++n)
            for (std::size_t c = 0; c < width; ++c) {
                const std::size_t child = n * width + c;
                const bool exists = child < children.size();
                for (std::size_t axis = 0; axis < 3; ++axis) {  // a comparison with NaN is always false
                    nodes[n].min[axis][c] = exists ? children[child].min[axis] : not_a_number;
                    nodes[n].max[axis][c] = exists ? children[child].max[axis] : not_a_number;
                }
                if (exists) extend(around[n], children[child]);
            }
        levels_.push_back(std::move(nodes));
        children = std::move(around);
    }
}

std::vector<std::uint32_t> packed_order(const std::vector<ElementBox>& boxes, std::vector<std::uint32_t> elements,
                                        int threads)
{
    std::vector<Range> ranges{{0, elements.size()}};
    while (std::any_of(ranges.begin(), ranges.end(), [](const Range& range) { return range.tiles() > 1; })) {
        std::vector<std::array<Range, 2>> halves(ranges.size());
        parallel_for(ranges.size(), threads, {}, [&](std::size_t r) {
            const Range& range = ranges[r];
            halves[r] = range.tiles() > 1 ? split(boxes, elements, range)
                                          : std::array<Range, 2>{range, Range{range.end, range.end}};
        });
        ranges.clear();
        for (const auto& pair : halves)
            for (const Range& range : pair)
                if (range.first < range.end) ranges.push_back(range);
    }
    for (const Range& range : ranges)
        std::sort(elements.begin() + std::ptrdiff_t(range.first), elements.begin() + std::ptrdiff_t(range.end));
    return elements;
}

}  // namespace spawnfield
