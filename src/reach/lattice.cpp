#include "reach/lattice.h"

#include <algorithm>

namespace spawnfield {
namespace {

/// Returns the angle between two neighbouring headings, rad.
double angle_between(int heading, int other)
{
    return std::abs(std::remainder(lattice_yaw(other) - lattice_yaw(heading), 2 * std::numbers::pi));
}

}  // namespace

Curve curve_in_corner(double length, double next_length, double turn)
{
    const double tangent = std::min(length, next_length);  // from the corner to both ends of the arc
    return {length - tangent, turn * tangent / std::tan(turn / 2), next_length - tangent, turn};
}

Lattice::Lattice(double turning_radius) : turning_radius_(turning_radius)
{
    for (const Way way : all_ways)
        for (int heading = 0; heading < lattice_headings; ++heading) {
            WayEnd& end = ends_[std::size_t(way)][std::size_t(heading)];
            end.heading = heading;
            if (way == Way::Left || way == Way::Turn) end.heading = lattice_heading(heading, 1);
            if (way == Way::Right) end.heading = lattice_heading(heading, -1);
            end.move = lattice_move(way == Way::Aside ? to_the_left(heading) : heading);
            if (way == Way::Turn) end.move = {0, 0};
            if (is_curve(way))
                end.move = corner(way, heading) + lattice_move(end.heading) * moves(end.heading, heading);
            longest_ = std::max(longest_, end.move.length());
            most_rows_ = std::max(most_rows_, std::abs(end.move.rows));
        }
}

/// Returns the number of moves at a heading, on a curve from or to another heading.
int Lattice::moves(int heading, int other) const
{
    constexpr double rounding = 1e-9;
    const double tangent = turning_radius_ * std::tan(angle_between(heading, other) / 2);
    return std::max(1, int(std::ceil(tangent / lattice_move(heading).length() - rounding)));
}

LatticeMove Lattice::corner(Way way, int heading) const
{
    return lattice_move(heading) * moves(heading, end(way, heading).heading);
}

Curve Lattice::curve(Way way, int heading) const
{
    const int last = end(way, heading).heading;
    return curve_in_corner(corner(way, heading).length(), moves(last, heading) * lattice_move(last).length(),
                           angle_between(heading, last));
}

double Lattice::length(Way way, int heading) const
{
    return is_curve(way) ? curve(way, heading).length() : end(way, heading).move.length();
}

}  // namespace spawnfield
