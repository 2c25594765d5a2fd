#include "geometry/tile_tree.h"

#include "base/parallel.h"

#include <limits>
#include <span>

namespace spawnfield {
namespace {

constexpr float no_limit = std::numeric_limits<float>::infinity(),
                not_a_number = std::numeric_limits<float>::quiet_NaN();

ElementBox empty_box() { return {{no_limit, no_limit, no_limit}, {-no_limit, -no_limit, -no_limit}}; }

/// An element while elements are put into order. Elements that are compared lie beside each other in memory, unlike
/// their boxes.
struct Entry {
    std::array<double, 3> centre;  ///< twice that of its box
    std::uint32_t element;
};

struct Range {
    std::size_t first, end;
    std::size_t tiles() const { return (end - first + TileBoxes::most - 1) / TileBoxes::most; }
};

/// Returns the axis along which the centres reach farthest.
std::size_t longest_axis(std::span<const Entry> entries)
{
    std::array<double, 3> low = entries.front().centre, high = low;
    for (const Entry& entry : entries)
        for (std::size_t axis = 0; axis < 3; ++axis) {
            low[axis] = std::min(low[axis], entry.centre[axis]);
            high[axis] = std::max(high[axis], entry.centre[axis]);
        }
    std::size_t longest = 0;
    for (const std::size_t axis : {1, 2})
        if (high[axis] - low[axis] > high[longest] - low[longest]) longest = axis;
    return longest;
}

/// Splits a range of elements along the longest side of what their centres cover. The first part gets a power of two of
/// full tiles, so that 16 consecutive tiles are whole parts.
std::array<Range, 2> split(std::vector<Entry>& entries, const Range& range)
{
    const auto begin = entries.begin() + std::ptrdiff_t(range.first), end = entries.begin() + std::ptrdiff_t(range.end);
    const std::size_t axis = longest_axis({begin, end});
    const std::size_t middle = range.first + std::bit_ceil(range.tiles()) / 2 * TileBoxes::most;
    std::nth_element(begin, entries.begin() + std::ptrdiff_t(middle), end, [axis](const Entry& a, const Entry& b) {
        return a.centre[axis] < b.centre[axis] || (a.centre[axis] == b.centre[axis] && a.element < b.element);
    });
    return {Range{range.first, middle}, Range{middle, range.end}};
}

}  // namespace

TileTree::TileTree(std::vector<ElementBox> boxes) : boxes_(std::move(boxes))
{
    std::vector<ElementBox> of_nodes;
    std::span<const ElementBox> children = boxes_;
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
        of_nodes = std::move(around);
        children = of_nodes;
    }
}

std::vector<std::uint32_t> packed_order(const std::vector<ElementBox>& boxes, std::vector<std::uint32_t> elements,
                                        int threads)
{
    std::vector<Entry> entries(elements.size());
    for (std::size_t k = 0; k < elements.size(); ++k) {
        const ElementBox& box = boxes[elements[k]];
        for (std::size_t axis = 0; axis < 3; ++axis)
            entries[k].centre[axis] = double(box.min[axis]) + double(box.max[axis]);
        entries[k].element = elements[k];
    }
    std::vector<Range> ranges{{0, elements.size()}};
    while (std::any_of(ranges.begin(), ranges.end(), [](const Range& range) { return range.tiles() > 1; })) {
        std::vector<std::array<Range, 2>> halves(ranges.size());
        parallel_for(ranges.size(), threads, {}, [&](std::size_t r) {
            const Range& range = ranges[r];
            halves[r] = range.tiles() > 1 ? split(entries, range)
                                          : std::array<Range, 2>{range, Range{range.end, range.end}};
        });
        ranges.clear();
        for (const auto& pair : halves)
            for (const Range& range : pair)
                if (range.first < range.end) ranges.push_back(range);
    }
    parallel_for(ranges.size(), threads, {}, [&](std::size_t r) {
        const auto [first, end] = ranges[r];
        for (std::size_t k = first; k < end; ++k) elements[k] = entries[k].element;
        std::sort(elements.begin() + std::ptrdiff_t(first), elements.begin() + std::ptrdiff_t(end));
    });
    return elements;
}

}  // namespace spawnfield
