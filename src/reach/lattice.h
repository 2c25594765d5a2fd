#pragma once

#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <numbers>

namespace spawnfield {

/// The headings of a drivable graph are those in which a straight way leads to another column after one or two rows or
/// columns. Source: Pivtoraiko, Kelly, Efficient constrained path planning via search in state lattices, 2005.
inline constexpr int lattice_headings = 16;

/// The way from a column to the next one, in columns and rows.
struct LatticeMove {
    int cols, rows;

    double length() const { return std::hypot(double(cols), double(rows)); }  ///< in steps of the grid
    constexpr LatticeMove operator+(const LatticeMove& other) const { return {cols + other.cols, rows + other.rows}; }
    constexpr bool operator==(const LatticeMove&) const = default;
    constexpr LatticeMove operator*(int times) const { return {times * cols, times * rows}; }
};

/// Returns the heading that follows after some more, counterclockwise.
constexpr int lattice_heading(int heading, int more) { return (heading + more + lattice_headings) % lattice_headings; }

/// Returns the way straight ahead at a heading, 0 .. 15. Heading 0 is along x; they are counted counterclockwise.
constexpr LatticeMove lattice_move(int heading)
{
    constexpr std::array<LatticeMove, lattice_headings> moves{{{1, 0},
                                                               {2, 1},
                                                               {1, 1},
                                                               {1, 2},
                                                               {0, 1},
                                                               {-1, 2},
                                                               {-1, 1},
                                                               {-2, 1},
                                                               {-1, 0},
                                                               {-2, -1},
                                                               {-1, -1},
                                                               {-1, -2},
                                                               {0, -1},
                                                               {1, -2},
                                                               {1, -1},
                                                               {2, -1}}};
    return moves[std::size_t(heading)];
}

/// Returns the yaw of a heading, -pi < yaw <= pi, rad.
inline double lattice_yaw(int heading)
{
    static const auto yaws = [] {
        std::array<double, lattice_headings> out{};
        for (int k = 0; k < lattice_headings; ++k)
            out[std::size_t(k)] = std::atan2(double(lattice_move(k).rows), double(lattice_move(k).cols));
        return out;
    }();
    return yaws[std::size_t(heading)];
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

inline constexpr std::array all_ways{Way::Ahead, Way::Left, Way::Right, Way::Aside, Way::Turn};
constexpr bool is_curve(Way way) { return way == Way::Left || way == Way::Right; }

/// Where a way leads.
struct WayEnd {
    LatticeMove move;
    int heading;
};

/// A line, an arc that touches both lines, and a line; one of the lines has the length 0.
struct Curve {
    double first, arc, last;  ///< lengths
    double turn;              ///< angle of the arc, > 0, rad

    double length() const { return first + arc + last; }
    double radius() const { return arc / turn; }
};

/// Returns the curve in a corner between two straight lines with these lengths. `turn`: the angle between their
/// directions, 0 .. pi. The arc is as large as the shorter line admits.
Curve curve_in_corner(double length, double next_length, double turn);

/// The ways of a drivable graph. A curve leads along some moves at its first heading to a corner, and along some moves
/// at its last heading from there, as seen from above; the robot drives along curve_in_corner() of these two lines.
class Lattice {
public:
    /// `turning_radius`: of all curves at least, in steps of the grid. With 0, there is one move to the corner, and one
    /// from there.
    explicit Lattice(double turning_radius = 0);

    const WayEnd& end(Way way, int heading) const { return shape(way, heading).end; }
    /// Returns the way from a column to the corner of a curve.
    LatticeMove corner(Way way, int heading) const { return shape(way, heading).corner; }
    const Curve& curve(Way way, int heading) const { return shape(way, heading).curve; }  ///< in steps of the grid
    double length(Way way, int heading) const { return shape(way, heading).length; }      ///< as seen from above, steps
    double longest() const { return longest_; }      ///< largest distance between the ends of a way, steps of the grid
    int longest_rows() const { return most_rows_; }  ///< largest number of rows that a way leads up or down

private:
    struct Shape {
        WayEnd end{};
        LatticeMove corner{};  ///< of a curve
        Curve curve{};         ///< the same
        double length = 0;     ///< in steps of the grid
    };
    const Shape& shape(Way way, int heading) const { return shapes_[std::size_t(way)][std::size_t(heading)]; }
    static Shape shape_of(Way way, int heading, double turning_radius);

    std::array<std::array<Shape, lattice_headings>, way_count> shapes_;
    double longest_ = 0;
    int most_rows_ = 0;
};

/// A set of headings; bit k is heading k.
using HeadingSet = std::uint16_t;

inline bool has_heading(HeadingSet set, int heading) { return (set >> heading & 1) != 0; }

}  // namespace spawnfield
