#pragma once

#include "random.h"

#include <spawnfield/shape.h>

#include <string>
#include <vector>

/// Things that consist of boxes and capsules. Each is built around its own origin with the ground at z = 0, in metres.
namespace worlds {

/// One box or capsule of a thing.
struct Element {
    std::string name;  ///< unique in the thing: "trunk", "rim-3", …
    spawnfield::Shape shape;
};
using Compound = std::vector<Element>;

struct HouseSize {
    double length, width, walls;  ///< m: along x, along y, height up to the eaves
};

/// Depth in m by which things reach into the ground, because the ground may fall away beside them.
inline constexpr double sunk = 1.2;

Compound house_of_boxes(Random& random, const HouseSize& size);  ///< walls, a gabled roof along x, a chimney
Compound church_of_boxes();                                      ///< a nave along x with a tower at its end

Compound broad_tree(Random& random);  ///< a bare trunk 2 to 3 m high under a round crown
Compound conifer(Random& random);     ///< the crown begins less than 1 m above the ground
Compound bush(Random& random);        ///< at least waist-high
Compound boulder(Random& random);     ///< one or two boxes

Compound fountain();                    ///< a rim of 9 m diameter with a column in the middle
Compound bench();                       ///< along x, with the backrest at larger y
Compound street_lamp();                 ///< with its arm along x
Compound car_of_boxes(Random& random);  ///< along x
Compound fence(double length);          ///< along x from the origin, posts and two rails

/// Returns a jetty along -x from the origin. The top of its deck is at z = 0, the lower ends of its piles at -depth.
Compound jetty(double length, double depth);
Compound hut();  ///< 2.8 m high
Compound mast(double height);
Compound border_stone();

}  // namespace worlds
