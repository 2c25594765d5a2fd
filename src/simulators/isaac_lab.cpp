#include "base/number.h"
#include "simulators/npy.h"

#include <spawnfield/error.h>
#include <spawnfield/simulators.h>

#include <algorithm>
#include <cmath>

namespace spawnfield {
namespace {

/// Returns the number of the part that contains a value, if [low, high] is divided into `count` equal parts. Values
/// beyond the ends belong to the first or last part.
int part_of(double value, double low, double high, int count)
{
    const double share = high > low ? (value - low) / (high - low) : 0;
    return std::clamp(int(std::floor(std::clamp(share, 0.0, 1.0) * count)), 0, count - 1);
}

void check(const TileGrid& grid)
{
    for (const int count : {grid.rows, grid.cols})
        if (count < 1 || count > 10000) throw ArgumentError("terrain_patches", "rows or cols", count, "1 .. 10000");
}

std::vector<std::vector<Vec3>> tiles_of(std::span<const Vec3> points, const TileGrid& grid)
{
    std::vector<std::vector<Vec3>> tiles(std::size_t(grid.rows) * std::size_t(grid.cols));
    const Bounds& b = grid.bounds;
    for (const Vec3& p : points) {
        const int row = part_of(p.x(), b.min.x(), b.max.x(), grid.rows),
                  col = part_of(p.y(), b.min.y(), b.max.y(), grid.cols);
        tiles[std::size_t(row * grid.cols + col)].push_back(p);
    }
    return tiles;
}

void append(std::vector<float>& values, const Vec3& point)
{
    for (int axis = 0; axis < 3; ++axis) values.push_back(float(point[axis]));
}

}  // namespace

std::string root_poses_npy(std::span<const RobotStart> robots, QuaternionOrder order)
{
    std::vector<double> values;
    values.reserve(robots.size() * 7);
    for (const RobotStart& robot : robots) {
        const Eigen::Quaterniond q = quaternion_in(Frame::Ros, robot.rpy);
        values.insert(values.end(), robot.position.data(), robot.position.data() + 3);
        if (order == QuaternionOrder::Wxyz)
            values.insert(values.end(), {q.w(), q.x(), q.y(), q.z()});
        else
            values.insert(values.end(), {q.x(), q.y(), q.z(), q.w()});
    }
    return npy({robots.size(), 7}, values);
}

TerrainPatches terrain_patches(std::span<const Vec3> points, const TileGrid& grid)
{
    check(grid);
    const std::vector<std::vector<Vec3>> tiles = tiles_of(points, grid);
    TerrainPatches out;
    for (const std::vector<Vec3>& tile : tiles) out.patches_per_tile = std::max(out.patches_per_tile, tile.size());
    std::vector<float> patches, origins;
    for (std::size_t i = 0; i < tiles.size(); ++i) {
        const std::vector<Vec3>& tile = tiles[i];
        if (tile.empty() && !points.empty())
            throw ArgumentError(
                "terrain_patches",
                "tile " + std::to_string(i / std::size_t(grid.cols)) + "," +
                    std::to_string(i % std::size_t(grid.cols)) +
                    " (row, column, from 0) has no spawn, but each tile needs one; ask for more spawns or fewer tiles");
        for (std::size_t n = 0; n < out.patches_per_tile; ++n) append(patches, tile[n % tile.size()]);
        append(origins, tile.empty() ? Vec3(Vec3::Constant(std::nan(""))) : tile.front());
    }
    const std::size_t rows = std::size_t(grid.rows), cols = std::size_t(grid.cols);
    out.flat_patches = npy({rows, cols, out.patches_per_tile, 3}, patches);
    out.terrain_origins = npy({rows, cols, 3}, origins);
    return out;
}

}  // namespace spawnfield
