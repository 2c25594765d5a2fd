#include "map/occupancy_towers.h"

#include "base/bytes.h"

#include <spawnfield/error.h>

#include <algorithm>
#include <array>

namespace spawnfield {
namespace {

constexpr int cubes_high = 1 << (tree_depth - tower_level);  // cubes in a tower

/// The content of the cubes of one tower while they are read.
struct OpenTower {
    std::vector<Content> contents = std::vector<Content>(cubes_high, Content::Unknown);  // from the lowest up
    std::map<int, TreeBytes> cubes;
};

/// Goes through the nodes of a .bt file in the order in which they are written.
class TowerReader {
public:
    TowerReader(const std::filesystem::path& file, std::string_view nodes, const TowerGrid& grid)
        : file_(file), nodes_(nodes), grid_(grid), towers_(grid.count())
    {
    }

    std::vector<Tower> run()
    {
        read_node(tree_depth, 0, 0, 0);
        if (next_ != nodes_.size()) fail("has more nodes than its tree");
        std::vector<Tower> out(towers_.size());
        for (std::size_t t = 0; t < out.size(); ++t) {
            for (int z = 0; z < cubes_high; ++z) append(out[t].profile, z + 1, towers_[t].contents[std::size_t(z)]);
            out[t].cubes = std::move(towers_[t].cubes);
        }
        return out;
    }

private:
    [[noreturn]] void fail(const std::string& what) const
    {
        throw FileError(file_.string(), what + "; bake the map again");
    }

    std::array<Content, 8> children()
    {
        if (nodes_.size() - next_ < 2) fail("is cut short");
        const unsigned bits = static_cast<unsigned char>(nodes_[next_]) |
                              static_cast<unsigned>(static_cast<unsigned char>(nodes_[next_ + 1])) << 8;
        next_ += 2;
        std::array<Content, 8> out;
        for (unsigned child = 0; child < 8; ++child) out[child] = Content(bits >> (2 * child) & 3);
        return out;
    }

    /// Reads an inner node above tower_level. x, y and z are in cubes of its level.
    void read_node(int level, int x, int y, int z)
    {
        const std::array<Content, 8> contents = children();
        for (int child = 0; child < 8; ++child) {
            const Content content = contents[std::size_t(child)];
            const int child_x = 2 * x + (child & 1), child_y = 2 * y + (child >> 1 & 1), child_z = 2 * z + (child >> 2);
            if (content != Content::Mixed)
                fill(level - 1, child_x, child_y, child_z, content);
            else if (level - 1 > tower_level)
                read_node(level - 1, child_x, child_y, child_z);
            else
                read_cube(child_x, child_y, child_z);
        }
    }

    /// Sets the content of all cubes in a leaf.
    void fill(int level, int x, int y, int z, Content content)
    {
        if (content == Content::Unknown) return;
        const int side = 1 << (level - tower_level);
        const auto first = [&](int place, int from) { return std::max(place * side, from); };
        for (int row = first(y, grid_.y0); row < std::min((y + 1) * side, grid_.y0 + grid_.rows); ++row)
            for (int col = first(x, grid_.x0); col < std::min((x + 1) * side, grid_.x0 + grid_.cols); ++col) {
                auto& contents = towers_[grid_.index(col, row)].contents;
                std::fill_n(contents.begin() + z * side, side, content);
            }
    }

    void read_cube(int x, int y, int z)
    {
        if (!grid_.contains(x, y)) fail("has voxels beyond the bounds of the map");
        OpenTower& tower = towers_[grid_.index(x, y)];
        tower.contents[std::size_t(z)] = Content::Mixed;
        TreeBytes& cube = tower.cubes[z];
        cube.inner = 0;
        const std::size_t begin = next_;
        count_nodes(tower_level, cube);
        cube.nodes = nodes_.substr(begin, next_ - begin);
    }

    void count_nodes(int level, TreeBytes& cube)
    {
        if (level == 0) fail("has a tree that is too deep");
        const std::array<Content, 8> contents = children();
        const auto mixed = std::count(contents.begin(), contents.end(), Content::Mixed),
                   unknown = std::count(contents.begin(), contents.end(), Content::Unknown);
        cube.inner += std::size_t(mixed);
        cube.leaves += contents.size() - std::size_t(mixed + unknown);
        for (auto left = mixed; left > 0; --left) count_nodes(level - 1, cube);
    }

    const std::filesystem::path& file_;
    const std::string_view nodes_;
    const TowerGrid grid_;
    std::vector<OpenTower> towers_;
    std::size_t next_ = 0;  ///< byte of the next node
};

}  // namespace

std::vector<Tower> read_towers(const std::filesystem::path& file, const TowerGrid& grid)
{
    const Bytes bytes = map_file(file);
    constexpr std::string_view before_nodes = "\ndata\n";
    const std::size_t data = bytes.view.find(before_nodes);
    if (data == std::string_view::npos) throw FileError(file.string(), "has no line `data`; bake the map again");
    return TowerReader(file, bytes.view.substr(data + before_nodes.size()), grid).run();
}

}  // namespace spawnfield
