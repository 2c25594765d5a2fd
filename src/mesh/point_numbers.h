#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <unordered_map>

namespace spawnfield {

/// Numbers points in the order in which they come. Points of equal coordinates have one number: they are welded.
template <class Coordinate>
class PointNumbers {
public:
    struct Entry {
        std::uint32_t number;
        bool is_new;
    };

    Entry add(Coordinate x, Coordinate y, Coordinate z)
    {
        const std::array key{x + Coordinate(0), y + Coordinate(0), z + Coordinate(0)};  // -0 becomes 0
        const auto [entry, is_new] = numbers_.try_emplace(key, std::uint32_t(numbers_.size()));
        return {entry->second, is_new};
    }

private:
    struct Hash {
        std::size_t operator()(const std::array<Coordinate, 3>& point) const
        {
            std::size_t hash = 0;
            for (const Coordinate c : point) hash = hash * 1000003 + std::hash<Coordinate>{}(c);
            return hash;
        }
    };
    std::unordered_map<std::array<Coordinate, 3>, std::uint32_t, Hash> numbers_;
};

}  // namespace spawnfield
