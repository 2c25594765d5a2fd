#pragma once

#include <spawnfield/scene.h>

#include <cstdint>
#include <filesystem>

namespace spawnfield {

/// A 2D occupancy map, as the map servers of nav2 and ROS read it.
struct Nav2Map {
    enum class Cell : std::uint8_t { Unknown, Free, Occupied };
    int rows = 0, cols = 0;
    double resolution = 0;             ///< m, side of a cell
    double x = 0, y = 0, yaw = 0;      ///< pose of the lower left corner of the lower left cell, m, rad
    std::vector<Cell> cells;           ///< row after row, row 0 the uppermost
    std::vector<std::string> notices;  ///< about defaults and keys that are ignored

    Cell cell(int row, int col) const { return cells[std::size_t(row) * std::size_t(cols) + std::size_t(col)]; }
    /// Returns the point, at z = 0, where two lines of the grid cross: row lines 0 (above row 0) .. rows, column lines
    /// 0 .. cols.
    Vec3 corner(int row_line, int col_line) const;
};

/// Returns whether a YAML file is a 2D map: it has the key `image` and not the key `format`. False for a file that is
/// not YAML.
bool is_nav2_map(const std::filesystem::path& file);

/// Reads a 2D map and its image. The keys are image (PGM, or PNG with 1 to 4 channels), resolution, origin, negate,
/// occupied_thresh, free_thresh and mode.
///
/// `value` is the mean of a pixel's colours (in mode trinary also of alpha). The occupancy p is (255 - value) / 255, or
/// value / 255 with negate. A cell is occupied if p > occupied_thresh, free if p < free_thresh, else unknown. In mode
/// scale, a pixel that is not opaque is unknown. In mode raw, values are p in per cent, values over 100 are unknown,
/// and negate has no effect. Throws FileError. Source: nav2_map_server (map_io.cpp) and ROS wiki's map_server, "Value
/// Interpretation".
Nav2Map read_nav2_map(const std::filesystem::path& file);

/// Appends the part "floor", at z = 0 under all cells that are not unknown, and the part "walls": boxes from z = 0 up
/// to wall_height (m) that fill exactly the occupied cells. `floor` and `walls` are the labels of the parts.
void append_nav2_map(Scene& scene, const Nav2Map& map, Label floor, Label walls, double wall_height);

}  // namespace spawnfield
