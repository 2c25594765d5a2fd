#pragma once

#include "hand_scene.h"
#include "random.h"

/// What stands in the benchmark's landscapes: closed pieces around their own origin, the ground at z = 0, metres.
namespace worlds {

using Pieces = std::vector<hand::Mesh>;

hand::Mesh ball();  ///< of radius 1, 80 triangles

/// A profile in y and z, counterclockwise seen from +x, extruded along x.
hand::Mesh profile_along_x(const std::vector<Eigen::Vector2d>& profile, double length);

/// A profile in x and z, counterclockwise seen from -y, extruded from y0 to y1.
hand::Mesh profile_along_y(const std::vector<Eigen::Vector2d>& profile, double y0, double y1);

/// A building of blocks: what lies between neighbouring coordinates is filled or not. Closed, whatever is filled.
struct BlockGrid {
    std::vector<double> x, y, z;                ///< m, ascending
    std::function<bool(int, int, int)> filled;  ///< block (i, j, k) lies between x[i] and x[i + 1], …
};
hand::Mesh blocks(const BlockGrid& grid);

/// Walls with gables, a roof that juts out, a chimney, at times a wing; `foundation` m deep. Along x.
Pieces house(Random& random, double foundation);

struct RecessedHouse {
    double foundation = 1;  ///< m below the ground
    int least_storeys = 1, most_storeys = 3;
};

/// A block of a house, along x, its door to -y: windows and the door are recesses; some have an upper storey set back.
hand::Mesh recessed_house(Random& random, const RecessedHouse& plan = {});

Pieces tree(Random& random);  ///< trunk and crown, either of needles (cones) or of leaves (a rough ball)
Pieces car(Random& random);   ///< a coarse body on four wheels, along x
Pieces rock(Random& random);  ///< a rough ball, half sunk

/// A post at `from`, and two rails 2 to 4 cm thick from there to `to`.
Pieces fence_panel(Random& random, const spawnfield::Vec3& from, const spawnfield::Vec3& to);

/// Adds a part of these pieces, named after its number in the scene.
void add_thing(spawnfield::Scene& scene, const char* name, spawnfield::Label label, const Pieces& pieces,
               const spawnfield::Pose& pose);

}  // namespace worlds
