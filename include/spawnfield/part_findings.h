#pragma once

#include <spawnfield/export.h>
#include <spawnfield/map.h>

#include <optional>
#include <string>
#include <vector>

/// Functions that find parts of a scene that are probably placed wrongly: parts that float, are sunken into the ground,
/// or overlap.
///
/// They examine *props*: all parts whose names are equal before the first "::" are one prop (the collisions of one
/// model of a world), and none of its elements is terrain or water. Names without "::" are props of one part. Parts of
/// the same prop are not compared with each other.
namespace spawnfield {

struct PartLimits {
    double gap = 0.02;      ///< m, >= 0: props that are at most this far from each other, or from the ground, touch
    double overlap = 0.01;  ///< m, > 0: overlaps that are not deeper than this do not count
    /// Globs of names (as for parts_that_match()); parts that match are in no finding.
    std::vector<std::string> allow = {};
    int threads = 0;  ///< 0: all cores; results are the same for any number
    Progress progress = {};
};

/// Props that hang in the air together.
struct FloatingProps {
    std::vector<std::string> props;  ///< names, in the order of the scene
    Vec3 lowest = Vec3::Zero();      ///< a lowest point of them, m
    /// Length of the vertical line from `lowest` down to the next solid or surface that is not one of them, m, and the
    /// name of its part. Nothing: there is none.
    std::optional<double> height;
    std::string below = {};
};

/// A prop that is mostly below the ground.
struct SunkenProp {
    std::string prop;
    double share = 0;           ///< of its length on the vertical lines, below the ground, > 0.5 .. 1
    double top = 0;             ///< its highest point on the lines, m
    std::size_t lines = 0;      ///< number of vertical lines that meet it
    Vec3 place = Vec3::Zero();  ///< the middle of its bounding box, m
};

/// Two parts whose solids overlap.
struct Overlap {
    std::string a, b;  ///< names of parts, in the order of the scene
    double depth = 0;  ///< m: diameter of a sphere that fits into both solids
    /// True: `depth` is the largest such diameter, to 1e-6 m. False: it is the largest that was found (meshes).
    bool is_exact = true;
    Vec3 place = Vec3::Zero();  ///< the centre of such a sphere, m
};

struct PartFindings {
    std::vector<FloatingProps> floating = {};  ///< in the order of their first props
    std::vector<SunkenProp> sunken = {};       ///< in the order of the scene
    std::vector<Overlap> overlaps = {};        ///< in the order of the scene
    std::size_t props = 0;                     ///< number of props that were examined
    /// Pairs of parts that may overlap by more than the limit, but for which neither was proven within the effort that
    /// a pair of meshes gets.
    std::vector<Overlap> undecided = {};
};

/// Returns the props that float, are sunken, or overlap.
///
/// Floating: two props touch if the distance between their surfaces is at most `gap`, or if one has a point inside a
/// solid of the other. A prop floats if no chain of props that touch leads from it to terrain or water. Distances are
/// exact (to 1e-9 m). Props that touch each other float together. A sunken prop is not listed as floating, too.
///
/// Sunken: on 16 x 16 vertical lines over its bounding box (or, if none of them meets it, on one through each of up to
/// 256 of its elements), the prop reaches from its lowest to its highest point there. More than half of these lengths
/// together is below the lowest layer of terrain on its line, or inside a solid of terrain.
///
/// Overlaps: a sphere of diameter `overlap` or more fits into a solid of one part and a solid of the other one. Solids
/// are boxes, spheres, cylinders, capsules, and all filled mesh pieces of a part together. Sheets (meshes with holes)
/// have no inside, so they overlap nothing.
///
/// Throws ArgumentError for limits beyond their ranges, and FileError for a damaged map.
SPAWNFIELD_API PartFindings find_wrong_parts(const Map& map, const PartLimits& limits = {});

}  // namespace spawnfield
