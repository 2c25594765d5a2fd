#pragma once

#include "base/bits.h"
#include "base/rect.h"
#include "geometry/tile.h"

#include <vector>

namespace spawnfield {

/// A tree of the boxes of tiles: a node has 16 consecutive tiles or nodes, of which the last node may have fewer. The
/// tiles must be in an order in which neighbours in space follow each other (packed_order). So no node stores its
/// children: a packed R-tree (Roussopoulos, Leifker, Direct spatial search on pictorial databases using packed R-trees,
/// 1985).
class TileTree {
public:
    explicit TileTree(std::vector<ElementBox> boxes);

    const std::vector<ElementBox>& boxes() const { return boxes_; }  ///< of the tiles

    /// Calls visit(tile) for the number of each tile whose box meets the closed rectangle, ascending. May visit tiles
    /// that miss it by the rounding error of a float.
    template <class Visit>
    void visit(const Rect& area, const Visit& visit) const
    {
        visit_nodes<2>({area.low_x, area.low_y}, {area.high_x, area.high_y}, visit);
    }
    /// The same for a closed box.
    template <class Visit>
    void visit(const Bounds& space, const Visit& visit) const
    {
        visit_nodes<3>({space.min.x(), space.min.y(), space.min.z()}, {space.max.x(), space.max.y(), space.max.z()},
                       visit);
    }

private:
    static constexpr std::size_t width = 16;
    static constexpr std::array<std::uint32_t, width> bit_of_child = [] {
        std::array<std::uint32_t, width> bits{};
        for (std::size_t c = 0; c < width; ++c) bits[c] = std::uint32_t{1} << c;
        return bits;
    }();
    struct Node {
        std::array<std::array<float, width>, 3> min, max;  ///< of the children; those that do not exist meet nothing
    };

    template <std::size_t Axes, class Visit>
    void visit_nodes(const std::array<double, Axes>& low, const std::array<double, Axes>& high,
                     const Visit& visit) const
    {
        if (levels_.empty()) return;
        std::array<float, Axes> from, to;
        for (std::size_t axis = 0; axis < Axes; ++axis) {
            from[axis] = rounded_down(low[axis]);  // outwards: boxes up to one float beyond are visited, too
            to[axis] = rounded_up(high[axis]);
        }
        visit_below<Axes>(levels_.size() - 1, 0, from, to, visit);
    }

    template <std::size_t Axes, class Visit>
    void visit_below(std::size_t level, std::size_t node, const std::array<float, Axes>& from,
                     const std::array<float, Axes>& to, const Visit& visit) const
    {
        for_each_bit(children_of<Axes>(levels_[level][node], from, to), [&](std::uint32_t k) {
            const std::size_t child = node * width + k;
            if (level == 0)
                visit(child);
            else
                visit_below<Axes>(level - 1, child, from, to, visit);
        });
    }

    template <std::size_t Axes>
    static std::uint32_t children_of(const Node& node, const std::array<float, Axes>& from,
                                     const std::array<float, Axes>& to)
    {
        std::array<std::uint32_t, width> bits = bit_of_child;
        for (std::size_t axis = 0; axis < Axes; ++axis) {
            const float *const min = node.min[axis].data(), *const max = node.max[axis].data();
            const float low = from[axis], high = to[axis];
#pragma omp simd
            for (std::size_t c = 0; c < width; ++c) bits[c] = ((min[c] <= high) & (max[c] >= low)) ? bits[c] : 0;
        }
        std::uint32_t out = 0;
#pragma omp simd reduction(| : out)
        for (std::size_t c = 0; c < width; ++c) out |= bits[c];
        return out;
    }

    std::vector<ElementBox> boxes_;
    std::vector<std::vector<Node>> levels_;  ///< from the nodes whose children are tiles to the root
};

/// Returns the elements in an order in which each run of TileBoxes::most of them lies close together, and so do each 16
/// runs: ranges are split across the longest side of what they cover, again and again. `boxes` has the boxes of all
/// elements of the scene.
std::vector<std::uint32_t> packed_order(const std::vector<ElementBox>& boxes, std::vector<std::uint32_t> elements,
                                        int threads);

}  // namespace spawnfield
