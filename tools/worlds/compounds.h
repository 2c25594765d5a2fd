#pragma once

#include "random.h"

#include <spawnfield/shape.h>

#include <string>
#include <vector>

/// What stands in worlds of primitives: boxes and capsules around the thing's own origin, the ground at z = 0, metres.
namespace worlds {

/// One box or capsule of a thing.
struct Element {
    std::string name;  ///< within the thing: "trunk", "rim-3", …
    spawnfield::Shape shape;
};
using Compound = std::vector<Element>;

struct HouseSize {
    double length, width, walls;  ///< m: along x, along y, height up to the eaves
};

/// What stands in the ground reaches so far into it, m: it may fall away under it.
inline constexpr double sunk = 1.2;

Compound house_of_boxes(Random& random, const HouseSize& size);  ///< walls, a gabled roof along x, a chimney
Compound church_of_boxes();                                      ///< a nave along x with a tower at its end

Compound broad_tree(Random& random);  ///< a bare trunk 2 to 3 m high under a round crown
Compound conifer(Random& random);     ///< its crown begins less than 1 m above the ground
Compound bush(Random& random);        ///< waist-high and more
Compound boulder(Random& random);     ///< one or two boxes

Compound fountain();                    ///< a rim 9 m across and a column in its middle
Compound bench();                       ///< along x, its back at larger y
Compound street_lamp();                 ///< its arm along x
Compound car_of_boxes(Random& random);  ///< along x
Compound fence(double length);          ///< along x from the origin, posts and two rails

Compound jetty(double length,
               double depth);  ///< along -x from the origin, its deck's top at z = 0, its piles' feet at -depth
Compound hut();                ///< 2.8 m high
Compound mast(double height);
Compound border_stone();

}  // namespace worlds
