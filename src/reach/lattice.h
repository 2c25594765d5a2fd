#pragma once

#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>

namespace spawnfield {

/// The headings of a drivable graph are those in which a straight way leads to another column after one or two rows or
/// columns. Source: Pivtoraiko, Kelly, Efficient constrained path planning via search in state lattices, 2005.
inline constexpr int lattice_headings = 16;

/// The way from a column to the next one, in columns and rows.
struct LatticeMove {
    int cols, rows;

    double length() const { return std::hypot(double(cols), double(rows)); }  ///< in steps of the grid
    constexpr LatticeMove operator+(const LatticeMove& other) const { return {cols + other.cols, rows + other.rows}; }
};

/// Returns the heading that follows after some more, counterclockwise.
constexpr int lattice_heading(int heading, int more) { return (heading + more + lattice_headings) % lattice_headings; }

/// Returns the way straight ahead at a heading, 0 .. 15. Heading 0 is along x; they are counted counterclockwise.
constexpr LatticeMove lattice_move(int heading)
{
    constexpr std::array<LatticeMove, 4> quarter{{{1, 0}, {2, 1}, {1, 1}, {1, 2}}};
    LatticeMove out = quarter[std::size_t(heading % 4)];
    for (int turn = 0; turn < heading / 4; ++turn) out = {-out.rows, out.cols};
    return out;
}

/// Returns the yaw of a heading, -pi < yaw <= pi, rad.
inline double lattice_yaw(int heading)
{
    const LatticeMove move = lattice_move(heading);
    return std::atan2(double(move.rows), double(move.cols));
}

constexpr int to_the_left(int heading) { return lattice_heading(heading, lattice_headings / 4); }
constexpr int opposite(int heading) { return lattice_heading(heading, lattice_headings / 2); }

/// How a robot goes from one state to another one.
enum class Way : std::uint8_t {
    Ahead,  ///< straight ahead
    Left,   ///< ahead, in a curve to the next heading
    Right,  ///< ahead, in a curve to the heading before
    Aside,  ///< straight to the left, without a turn
    Turn    ///< on the spot, to the next heading
};
inline constexpr std::size_t way_count = 5;

/// Where a way leads.
struct WayEnd {
    LatticeMove move;
    int heading;
};

/// Returns where a way leads that begins at a heading.
constexpr WayEnd way_end(Way way, int heading)
{
    const int next = lattice_heading(heading, 1), before = lattice_heading(heading, -1);
    switch (way) {
    case Way::Left: return {lattice_move(heading) + lattice_move(next), next};
    case Way::Right: return {lattice_move(heading) + lattice_move(before), before};
    case Way::Aside: return {lattice_move(to_the_left(heading)), heading};
    case Way::Turn: return {{0, 0}, next};
    case Way::Ahead: break;
    }
    return {lattice_move(heading), heading};
}

inline constexpr int longest_way_rows = 3;  ///< largest number of rows that a way leads up or down

/// A set of headings; bit k is heading k.
using HeadingSet = std::uint16_t;

inline bool has_heading(HeadingSet set, int heading) { return (set >> heading & 1) != 0; }

}  // namespace spawnfield
