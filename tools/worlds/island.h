#pragma once

#include "hand_scene.h"
#include "landform.h"
#include "random.h"

namespace worlds {

using Vec2 = Eigen::Vector2d;

/// A grid of streets, turned against the axes. Block (i, j) lies between the middles of streets i and i + 1 (u = i
/// block_u) and j and j + 1 (v = j block_v); u runs along the blocks' longer sides.
struct StreetGrid {
    static constexpr double block_u = 96, block_v = 64, street = 10;  // m
    static constexpr double turn = 0.3;                               // rad, of u from x

    static Vec2 origin() { return {512, 428}; }  ///< in the world: the middle of the square
    static Vec2 to_world(const Vec2& uv);
    static Vec2 from_world(const Vec2& p);
};

/// The ground of the complex district: an island in a square of sea, its lower half partly flooded, streets over it,
/// and a canal that ends among them. A sheet of 2 m cells; beyond the island's rim there is none.
class Island {
public:
    static constexpr double low_x = -128, low_y = -212, side = 1280;  // m, of the square
    static constexpr double cell = 2, sea_level = 3.35;               // m
    static constexpr double canal_u = -StreetGrid::block_u / 2;       // m, of its middle line where the bridge is
    static constexpr double bridge_v = -StreetGrid::block_v;          // m, of the street that crosses it

    static constexpr int most_blocks = 16;  ///< in each direction from the middle

    explicit Island(Random& random);

    double height(const Vec2& p) const;     ///< m; beyond the rim as the sea bed goes on
    bool has_ground(const Vec2& p) const;   ///< whether the sheet reaches here
    bool is_settled(int i, int j) const;    ///< whether block (i, j) is part of the town
    bool is_in_town(const Vec2& uv) const;  ///< whether a place in the streets' frame lies in a settled block

    void add_to(spawnfield::Scene& scene) const;  ///< ground, streets and sea

private:
    struct Hill {
        Vec2 top;
        double height, spread;  ///< m; the spread is its shape's standard deviation
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
    std::vector<double> heights_;   ///< m, of the corners, row after row from the least y
    std::vector<char> has_ground_;  ///< of the cells, likewise
    std::vector<char> settled_;     ///< of the blocks
};

}  // namespace worlds
