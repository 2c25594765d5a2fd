#pragma once

#include "hand_scene.h"
#include "landform.h"
#include "random.h"

namespace worlds {

using Vec2 = Eigen::Vector2d;

/// A grid of streets, rotated against the axes. Block (i, j) lies between the middles of streets i and i + 1 (street i
/// is at u = i * block_u) and of streets j and j + 1 (street j is at v = j * block_v). The longer sides of the blocks
/// run along u.
struct StreetGrid {
    static constexpr double block_u = 96, block_v = 64, street = 10;  // m
    static constexpr double turn = 0.3;                               // rad, from x to u

    static Vec2 origin() { return {512, 428}; }  ///< in the world; the middle of the square
    static Vec2 to_world(const Vec2& uv);
    static Vec2 from_world(const Vec2& p);
};

/// The ground of the complex district: an island in a square of sea. Its lower half is partly flooded, streets cover
/// it, and a canal ends among them. The ground is a sheet of 2 m cells, and there is none beyond the rim of the island.
class Island {
public:
    static constexpr double low_x = -128, low_y = -212, side = 1280;  // m, of the square
    static constexpr double cell = 2, sea_level = 3.35;               // m
    static constexpr double canal_u = -StreetGrid::block_u / 2;  // m, of the middle line of the canal at the bridge
    static constexpr double bridge_v = -StreetGrid::block_v;     // m, of the street that crosses the canal

    static constexpr int most_blocks = 16;  ///< number of blocks in each direction from the middle

    explicit Island(Random& random);

    double height(const Vec2& p) const;     ///< m; beyond the rim the height of the sea bed continues
    bool has_ground(const Vec2& p) const;   ///< whether the sheet covers p
    bool is_settled(int i, int j) const;    ///< whether block (i, j) is part of the town
    bool is_in_town(const Vec2& uv) const;  ///< whether a place in the frame of the streets lies in a settled block

    void add_to(spawnfield::Scene& scene) const;  ///< ground, streets and sea

private:
    struct Hill {
        Vec2 top;
        double height, spread;  ///< m; the shape is a Gaussian with `spread` as its standard deviation
    };
    static constexpr int cells = int(side / cell);

    double smooth_height(const Vec2& p) const;
    double land(const Vec2& p) const;
    double inland(const Vec2& p) const;
    double from_shore(const Vec2& p) const;
    bool is_street(const Vec2& p) const;
    hand::Mesh sheet(bool streets) const;
    void choose_blocks();
    void shape(Random& random);
    void cut_rim();
    void raise_to_sea_level();
    static std::size_t slot(int row, int col) { return std::size_t(row) * (cells + 1) + std::size_t(col); }
    static std::size_t cell_slot(int row, int col) { return std::size_t(row) * cells + std::size_t(col); }
    static Vec2 middle(int row, int col) { return {low_x + cell * (col + 0.5), low_y + cell * (row + 0.5)}; }
    static Vec2 corner(int row, int col) { return {low_x + cell * col, low_y + cell * row}; }

    Waves bays_, coves_, shoals_, swell_, knolls_;
    std::vector<Hill> hills_;
    std::vector<double> heights_;   ///< m, of the corners of the cells; row after row, starting at the smallest y
    std::vector<char> has_ground_;  ///< of the cells, in the same order
    std::vector<char> settled_;     ///< of the blocks
};

}  // namespace worlds
