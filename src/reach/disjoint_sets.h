#pragma once

#include <algorithm>
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <numeric>
#include <vector>

namespace spawnfield {

/// Sets that are joined again and again. Any number of threads may call find() and join() at the same time. Source:
/// Anderson, Woll, Wait-free parallel algorithms for the union-find problem, 1991.
class DisjointSets {
public:
    void reserve(std::size_t count) { parents_.reserve(count); }

    /// Adds sets of one number each, until there are `count` numbers. Not while other threads use the sets.
    void grow(std::size_t count)
    {
        const std::size_t before = parents_.size();
        parents_.resize(count);
        std::iota(parents_.begin() + std::ptrdiff_t(before), parents_.end(), std::uint32_t(before));
    }

    /// Returns the smallest number of the set, if no other thread joins it.
    std::uint32_t find(std::uint32_t i)
    {
        for (;;) {
            std::uint32_t parent = at(i).load(std::memory_order_relaxed);
            if (parent == i) return i;
            const std::uint32_t above = at(parent).load(std::memory_order_relaxed);
            if (above != parent) at(i).compare_exchange_weak(parent, above, std::memory_order_relaxed);
            i = above;
        }
    }

    bool are_joined(std::uint32_t i, std::uint32_t j) { return find(i) == find(j); }

    void join(std::uint32_t i, std::uint32_t j)
    {
        for (;;) {
            i = find(i);
            j = find(j);
            if (i == j) return;
            std::uint32_t larger = std::max(i, j);
            if (at(larger).compare_exchange_strong(larger, std::min(i, j), std::memory_order_relaxed)) return;
        }
    }

private:
    std::atomic_ref<std::uint32_t> at(std::uint32_t i) { return std::atomic_ref(parents_[i]); }

    std::vector<std::uint32_t> parents_;  ///< a parent has a smaller number, or is the number itself
};

}  // namespace spawnfield
