#pragma once

#include <spawnfield/scene.h>

#include <cstdint>
#include <filesystem>

namespace spawnfield {

/// A 2D occupancy map as nav2's and ROS's map servers read it.
struct Nav2Map {
    enum class Cell : std::uint8_t { Unknown, Free, Occupied };
    int rows = 0, cols = 0;
    double resolution = 0;             ///< m, side of a cell
    double x = 0, y = 0, yaw = 0;      ///< pose of the lower left corner of the lower left cell, m, rad
    std::vector<Cell> cells;           ///< row after row, row 0 the uppermost
    std::vector<std::string> notices;  ///< what was assumed

    Cell at(int row, int col) const { return cells[std::size_t(row) * std::size_t(cols) + std::size_t(col)]; }
    /// Where lines of the grid cross, at z = 0: row lines 0 (above row 0) .. rows, column lines 0 .. cols.
    Vec3 corner(int row_line, int col_line) const;
};

/// Whether a YAML file is one: it has `image` and no `format`. False too for what is no YAML.
bool is_nav2_map(const std::filesystem::path& file);

/// Keys image (PGM, or PNG with 1 to 4 channels), resolution, origin, negate, occupied_thresh, free_thresh, mode.
///
/// p = (255 - value) / 255, or value / 255 with negate, of the mean of the colours (and alpha, in mode trinary). p >
/// occupied_thresh is occupied, p < free_thresh free, all else unknown. Mode scale: what is not opaque is unknown, else
/// the same; raw: values are per cent of p, over 100 unknown, and negate does not count. Throws FileError. Source:
/// nav2_map_server (map_io.cpp) and ROS wiki's map_server, "Value Interpretation".
Nav2Map read_nav2_map(const std::filesystem::path& file);

/// Appends part "floor", terrain at z = 0 under all cells that are not unknown, and part "walls", boxes from there up
/// to wall_height (m) that fill exactly the occupied cells. The labels given are those of the parts.
void append_nav2_map(Scene& scene, const Nav2Map& map, Label floor, Label walls, double wall_height);

}  // namespace spawnfield
