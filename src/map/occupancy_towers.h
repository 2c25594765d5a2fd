#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <string>
#include <vector>

namespace spawnfield {

// An occupancy tree is made and written in towers: columns of cubes with a side of 2^tower_level voxels, one above the
// other. Coordinates of cubes are in cubes from OctoMap's lowest key.

constexpr int key_offset = 32768;  // OctoMap's key of the voxel that begins at 0
constexpr int tree_depth = 16;     // levels of an OcTree
constexpr int tower_level = 7;

/// Two-bit state of a child in a .bt file.
enum class Content : std::uint8_t { Unknown = 0, Free = 1, Occupied = 2, Mixed = 3 };

/// A part of a column of cubes: it begins where the stretch before it ends, and ends before cube `end`.
struct Stretch {
    int end;
    Content content;
};

using Profile = std::vector<Stretch>;

/// Extends a profile by cubes of this content up to cube `end`. Does nothing if the profile already reaches that far.
inline void append(Profile& profile, int end, Content content)
{
    const int from = profile.empty() ? 0 : profile.back().end;
    if (end <= from) return;
    if (!profile.empty() && profile.back().content == content)
        profile.back().end = end;
    else
        profile.push_back({end, content});
}

/// A tree in the form of a .bt file: for each inner node two bits for each of its children, then those children that
/// are inner nodes themselves.
struct TreeBytes {
    std::string nodes;
    std::size_t inner = 1, leaves = 0;  ///< numbers of nodes; the root is inner
};

struct Tower {
    Profile profile;
    std::map<int, TreeBytes> cubes;  ///< the nodes of Mixed cubes, by their z; `inner` does not count the cube itself
};

/// A rectangle of towers.
struct TowerGrid {
    int x0, y0, cols, rows;

    std::size_t count() const { return std::size_t(cols) * std::size_t(rows); }
    std::size_t index(int x, int y) const { return std::size_t(y - y0) * std::size_t(cols) + std::size_t(x - x0); }
    bool contains(int x, int y) const { return x >= x0 && y >= y0 && x < x0 + cols && y < y0 + rows; }
};

/// Reads the towers of a .bt file that write_occupancy() wrote, row after row. O(nodes). Throws FileError if the nodes
/// end too early or go too deep.
std::vector<Tower> read_towers(const std::filesystem::path& file, const TowerGrid& grid);

}  // namespace spawnfield
