#pragma once

#include "hand_scene.h"
#include "random.h"

/// Things that consist of closed pieces. Each is built around its own origin with the ground at z = 0, in metres.
namespace worlds {

using Pieces = std::vector<hand::Mesh>;

hand::Mesh ball();  ///< of radius 1, 80 triangles

/// Returns a profile in y and z, extruded along x. The profile is counterclockwise as seen from +x.
hand::Mesh profile_along_x(const std::vector<Eigen::Vector2d>& profile, double length);

/// Returns a profile in x and z, extruded from y0 to y1. The profile is counterclockwise as seen from -y.
hand::Mesh profile_along_y(const std::vector<Eigen::Vector2d>& profile, double y0, double y1);

/// A building that consists of blocks. The block between neighbouring coordinates is either filled or empty. The
/// surface is closed for every choice of filled blocks.
struct BlockGrid {
    std::vector<double> x, y, z;                ///< m, ascending
    std::function<bool(int, int, int)> filled;  ///< block (i, j, k) lies between x[i] and x[i + 1], …
};
hand::Mesh blocks(const BlockGrid& grid);

/// Returns a house along x: walls with gables, a roof that juts out, a chimney, and sometimes a wing. Its foundation
/// reaches `foundation` m into the ground.
Pieces house(Random& random, double foundation);

/// Returns the x of both ends of a wall of this length around 0, and of both sides of each of its evenly spaced
/// windows.
std::vector<double> window_borders(double length, int windows, double half_width);

struct RecessedHouse {
    double foundation = 1;  ///< m below the ground
    int least_storeys = 1, most_storeys = 3;
};

/// Returns a house along x as one block, with its door towards -y. Windows and the door are recesses. Some houses have
/// a top storey that is set back.
hand::Mesh recessed_house(Random& random, const RecessedHouse& plan = {});

Pieces tree(Random& random);  ///< a trunk and a crown, which is either cones or a rough ball
Pieces car(Random& random);   ///< a coarse body on four wheels, along x
Pieces rock(Random& random);  ///< a rough ball, half sunk

/// Returns a post at `from`, and two rails, 2 to 4 cm thick, from there to `to`.
Pieces fence_panel(Random& random, const spawnfield::Vec3& from, const spawnfield::Vec3& to);

/// Adds a part with these pieces. Its name is `name` with its number in the scene.
void add_thing(spawnfield::Scene& scene, const char* name, spawnfield::Label label, const Pieces& pieces,
               const spawnfield::Pose& pose);

}  // namespace worlds
