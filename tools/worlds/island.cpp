#include "island.h"

#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>
#include <numbers>

using namespace spawnfield;

namespace worlds {
namespace {

// Shares of the square. They decide where the rim and the sea level are.
constexpr double ground_share = 0.7325;  // share with ground; the columns on the rim itself come on top
constexpr double dry_share = 0.4335;     // share above the sea

// Lengths in m, in addition to those in StreetGrid.
constexpr double rim_radius = 583, shore_inland = 95;
constexpr double coast_width = 120, dune_height = 0.4;
constexpr double highest_block = 26;                                          // m above the sea
constexpr double bed_slope = 0.056, bank_slope = 0.5, steepest_block = 0.13;  // rise per run
constexpr double canal_depth = 2.5, canal_width = 30, canal_end = 80;
constexpr double kerb = 0.2, roughness = 0.4;

/// Returns the distance from the middle line of the canal, m; `uv` is in the frame of the streets.
double canal_distance(const Vec2& uv)
{
    const double middle = Island::canal_u + 8 * std::sin((uv.y() - Island::bridge_v) / 90);
    return std::hypot(uv.x() - middle, std::max(0.0, uv.y() - canal_end));
}

/// Returns waves in all directions, with wavelengths of 0.75 to 1.3 times `length` (m).
Waves waves(Random& random, double length)
{
    constexpr int count = 9;
    Waves out;
    for (int i = 0; i < count; ++i) {
        const double direction = 2 * std::numbers::pi * (i + random.between(0, 1)) / count;
        const double wavelength = length * random.between(0.75, 1.3);
        out.add(direction, wavelength, random.between(0, 2 * std::numbers::pi));
    }
    return out;
}

/// Returns the sum of the waves, scaled to mean 0 and standard deviation 1.
double swing(const Waves& waves, const Vec2& p) { return waves.sum_at(p) / std::sqrt(0.5 * double(waves.count())); }

}  // namespace

Vec2 StreetGrid::to_world(const Vec2& uv) { return origin() + Eigen::Rotation2Dd(turn) * uv; }
Vec2 StreetGrid::from_world(const Vec2& p) { return Eigen::Rotation2Dd(-turn) * (p - origin()); }

Island::Island(Random& random)
    : bays_(waves(random, 330)), coves_(waves(random, 90)), shoals_(waves(random, 200)), swell_(waves(random, 260)),
      knolls_(waves(random, 80))
{
    hills_ = {{{830, 800}, 36, 95}, {{600, 930}, 20, 80}, {{930, 520}, 14, 75}};
    for (Hill& hill : hills_) {
        const double east = random.between(-40, 40), north = random.between(-40, 40);
        hill.top += Vec2(east, north);
    }
    choose_blocks();
    shape(random);
    cut_rim();
    raise_to_sea_level();
}

/// Returns the distance inwards from the rim, m. The rim is a rounded square with bays and coves.
double Island::inland(const Vec2& p) const
{
    const Vec2 d = (p - StreetGrid::origin()).cwiseAbs();
    const double radius = std::cbrt(std::pow(d.x(), 3) + std::pow(d.y(), 3));
    return rim_radius - radius + 28 * std::clamp(swing(bays_, p), -1.5, 1.5) +
           5 * std::clamp(swing(coves_, p), -2.0, 2.0);
}

/// Returns the distance inwards from the shore, m. The distance between shore and rim varies.
double Island::from_shore(const Vec2& p) const
{
    return inland(p) - shore_inland - 24 * std::clamp(swing(shoals_, p), -1.6, 1.6);
}

/// Returns the height above the sea far from the shore and the canal, m: low in the south-west, hills in the
/// north-east.
double Island::land(const Vec2& p) const
{
    const double north_east = (p - StreetGrid::origin()).dot(Vec2(0.6, 0.8));
    double height = 0.5 + 0.9 * swing(swell_, p) + smooth_step(-80, 420, north_east) * (22 + 0.9 * swing(knolls_, p));
    for (const Hill& hill : hills_)
        height += hill.height * std::exp(-0.5 * (p - hill.top).squaredNorm() / (hill.spread * hill.spread));
    return height;
}

/// Returns the height above the sea without kerbs and roughness, m.
double Island::smooth_height(const Vec2& p) const
{
    const double depth = from_shore(p);
    if (depth < 0) return bed_slope * depth;
    const double dune = dune_height * std::min(1.0, depth / 10);
    const double bank = bank_slope * (canal_distance(StreetGrid::from_world(p)) - canal_width / 2) - canal_depth;
    return std::min(dune + land(p) * std::min(1.0, depth / coast_width), std::max(bank, -canal_depth));
}

/// Chooses the blocks of the town: inland, not too high and not too steep.
void Island::choose_blocks()
{
    for (int j = -most_blocks; j < most_blocks; ++j)
        for (int i = -most_blocks; i < most_blocks; ++i) {
            const Vec2 middle = StreetGrid::to_world(
                {(i + 0.5) * StreetGrid::block_u, (j + 0.5) * StreetGrid::block_v});
            const double east = land(middle + Vec2(20, 0)) - land(middle - Vec2(20, 0));
            const double north = land(middle + Vec2(0, 20)) - land(middle - Vec2(0, 20));
            settled_.push_back(from_shore(middle) > 25 && land(middle) < highest_block &&
                               std::hypot(east, north) / 40 < steepest_block);
        }
}

bool Island::is_settled(int i, int j) const
{
    if (std::max(std::abs(i), std::abs(j)) >= most_blocks) return false;
    return settled_[std::size_t((j + most_blocks) * 2 * most_blocks + i + most_blocks)];
}

bool Island::is_in_town(const Vec2& uv) const
{
    return is_settled(int(std::floor(uv.x() / StreetGrid::block_u)), int(std::floor(uv.y() / StreetGrid::block_v)));
}

/// Returns whether p is on a street. Streets run on all sides of the settled blocks.
bool Island::is_street(const Vec2& p) const
{
    const Vec2 uv = StreetGrid::from_world(p), block(StreetGrid::block_u, StreetGrid::block_v);
    const double half = StreetGrid::street / 2;
    const Vec2 off = (uv - uv.cwiseQuotient(block).array().round().matrix().cwiseProduct(block)).cwiseAbs();
    if (off.minCoeff() > half) return false;
    for (const double u : {-half, half})
        for (const double v : {-half, half})
            if (is_in_town(uv + Vec2(u, v))) return true;
    return false;
}

/// Computes all heights above the sea: smooth on the streets, which lie lower by one kerb, and rough elsewhere.
void Island::shape(Random& random)
{
    for (int row = 0; row <= cells; ++row)
        for (int col = 0; col <= cells; ++col) {
            const Vec2 p = corner(row, col);
            const double bump = random.between(-roughness, roughness);
            heights_.push_back(smooth_height(p) + (is_street(p) ? -kerb : bump));
        }
}

/// Gives ground to the given share of cells, those furthest inland, and none to the others.
void Island::cut_rim()
{
    std::vector<double> depths;
    for (int row = 0; row < cells; ++row)
        for (int col = 0; col < cells; ++col) depths.push_back(inland(middle(row, col)));
    std::vector<double> sorted = depths;
    const auto rim = sorted.begin() + std::ptrdiff_t((1 - ground_share) * double(sorted.size()));
    std::nth_element(sorted.begin(), rim, sorted.end());
    for (const double depth : depths) has_ground_.push_back(depth >= *rim);
}

/// Shifts all heights so that the sea level is as given and the given share of the square lies above it.
void Island::raise_to_sea_level()
{
    std::vector<double> sorted;
    for (int row = 0; row < cells; ++row)
        for (int col = 0; col < cells; ++col)
            if (has_ground_[cell_slot(row, col)]) sorted.push_back(heights_[slot(row, col)]);
    const auto shore = sorted.end() - std::ptrdiff_t(dry_share * cells * cells);
    std::nth_element(sorted.begin(), shore, sorted.end());
    for (double& height : heights_) height += sea_level - *shore;
}

double Island::height(const Vec2& p) const
{
    const double x = std::clamp((p.x() - low_x) / cell, 0.0, cells - 1e-9),
                 y = std::clamp((p.y() - low_y) / cell, 0.0, cells - 1e-9);
    const int col = int(x), row = int(y);
    const double u = x - col, v = y - row;
    return (1 - v) * ((1 - u) * heights_[slot(row, col)] + u * heights_[slot(row, col + 1)]) +
           v * ((1 - u) * heights_[slot(row + 1, col)] + u * heights_[slot(row + 1, col + 1)]);
}

bool Island::has_ground(const Vec2& p) const
{
    const int col = int(std::floor((p.x() - low_x) / cell)), row = int(std::floor((p.y() - low_y) / cell));
    return col >= 0 && row >= 0 && col < cells && row < cells && has_ground_[cell_slot(row, col)];
}

/// Returns the cells of the sheet that lie on streets, or all other cells.
hand::Mesh Island::sheet(bool streets) const
{
    hand::Mesh mesh;
    std::vector<std::uint32_t> numbers(heights_.size(), ~0u);
    const auto vertex = [&](int row, int col) {
        std::uint32_t& number = numbers[slot(row, col)];
        if (number == ~0u) {
            number = std::uint32_t(mesh.vertices.size());
            const Vec2 p = corner(row, col);
            mesh.vertices.emplace_back(p.x(), p.y(), heights_[slot(row, col)]);
        }
        return number;
    };
    for (int row = 0; row < cells; ++row)
        for (int col = 0; col < cells; ++col) {
            if (!has_ground_[cell_slot(row, col)] || is_street(middle(row, col)) != streets) continue;
            const std::uint32_t a = vertex(row, col), b = vertex(row, col + 1), c = vertex(row + 1, col + 1),
                                d = vertex(row + 1, col);
            mesh.triangles.insert(mesh.triangles.end(), {{a, b, d}, {b, c, d}});
        }
    return mesh;
}

void Island::add_to(Scene& scene) const
{
    for (const bool streets : {false, true}) {
        hand::add_mesh(scene, Label::Terrain, sheet(streets));
        scene.parts.back().name = streets ? "streets" : "ground";
    }
    const Pose centre = {{low_x + side / 2, low_y + side / 2, sea_level}, Mat3::Identity()};
    hand::add_mesh(scene, Label::Water, hand::moved(hand::rectangle(side, side), centre), {.kind = "plane"});
    scene.parts.back().name = "sea";
}

}  // namespace worlds
