#pragma once

#include <algorithm>
#include <cstdint>
#include <numeric>
#include <vector>

namespace spawnfield {

/// Sets that are joined again and again. Source: Tarjan, Efficiency of a good but not linear set union algorithm, 1975.
class DisjointSets {
public:
    explicit DisjointSets(std::size_t count) : parents_(count) { std::iota(parents_.begin(), parents_.end(), 0u); }

    std::uint32_t find(std::uint32_t i)
    {
        while (parents_[i] != i) i = parents_[i] = parents_[parents_[i]];
        return i;
    }

    /// Joins two sets. The set is then found by its smallest number.
    void join(std::uint32_t i, std::uint32_t j)
    {
        i = find(i);
        j = find(j);
        parents_[std::max(i, j)] = std::min(i, j);
    }

private:
    std::vector<std::uint32_t> parents_;
};

}  // namespace spawnfield
