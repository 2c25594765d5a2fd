#include "reach/lattice.h"

#include <algorithm>

namespace spawnfield {
namespace {

/// Returns the angle between two neighbouring headings, rad.
double angle_between(int heading, int other)
{
    return std::abs(std::remainder(lattice_yaw(other) - lattice_yaw(heading), 2 * std::numbers::pi));
}

/// Returns the number of moves at a heading, on a curve from or to a heading that differs by an angle (rad).
int moves_of(int heading, double turn, double turning_radius)
{
    constexpr double rounding = 1e-9;
    const double tangent = turning_radius * std::tan(turn / 2);
    return std::max(1, int(std::ceil(tangent / lattice_move(heading).length() - rounding)));
}

}  // namespace

Curve curve_in_corner(double length, double next_length, double turn)
{
    const double tangent = std::min(length, next_length);  // from the corner to both ends of the arc
    return {length - tangent, turn * tangent / std::tan(turn / 2), next_length - tangent, turn};
}

Lattice::Lattice(double turning_radius)
{
    for (const Way way : all_ways)
        for (int heading = 0; heading < lattice_headings; ++heading) {
            Shape& shape = shapes_[std::size_t(way)][std::size_t(heading)];
            shape = shape_of(way, heading, turning_radius);
            longest_ = std::max(longest_, shape.end.move.length());
            most_rows_ = std::max(most_rows_, std::abs(shape.end.move.rows));
        }
}

Lattice::Shape Lattice::shape_of(Way way, int heading, double turning_radius)
{
    Shape out;
    out.end = {lattice_move(way == Way::Aside ? to_the_left(heading) : heading), heading};
    if (way == Way::Turn) out.end = {{0, 0}, lattice_heading(heading, 1)};
    if (is_curve(way)) {
        const int last = lattice_heading(heading, way == Way::Left ? 1 : -1);
        const double turn = angle_between(heading, last);
        const LatticeMove end = lattice_move(last) * moves_of(last, turn, turning_radius);
        out.corner = lattice_move(heading) * moves_of(heading, turn, turning_radius);
        out.end = {out.corner + end, last};
        out.curve = curve_in_corner(out.corner.length(), end.length(), turn);
    }
    out.length = is_curve(way) ? out.curve.length() : out.end.move.length();
    return out;
}

}  // namespace spawnfield
