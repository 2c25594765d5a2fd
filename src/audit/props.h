#pragma once

#include "geometry/geometry_impl.h"

#include <spawnfield/part_findings.h>

namespace spawnfield {

/// An element of a prop.
struct PropElement {
    const Forest* forest;
    std::uint32_t tree, tile, element;
    std::uint32_t prop;  ///< index in Props::all
    double bottom;       ///< m
};

/// What part_findings.h calls a prop, or all parts of one name that have ground among their elements.
struct Prop {
    std::string name;
    Bounds bounds = {};       ///< of its elements, m
    bool is_ground = false;   ///< one of its elements is terrain or water
    bool is_allowed = false;  ///< a glob of PartLimits::allow matches one of its parts
    bool is_examined() const { return !is_ground && !is_allowed && !bounds.is_empty(); }
};

/// The parts of a geometry as props, and their elements.
struct Props {
    /// Throws FileError for a damaged map.
    Props(const Geometry& geometry, const std::vector<std::string>& allow);

    std::vector<Prop> all;          ///< in the order of the scene
    std::vector<std::uint32_t> of;  ///< of each part: its index in `all`
    std::vector<bool> is_allowed;   ///< of each part
    std::vector<bool> is_ground;    ///< of each part: one of its elements is terrain or water
    /// The elements of all props that are not ground: the lowest first, of equally low ones the first of the scene.
    std::vector<PropElement> elements;

    std::size_t examined() const;
};

std::vector<SunkenProp> find_sunken(const Geometry& geometry, const Props& props, int threads);

std::vector<FloatingProps> find_floating(const Geometry& geometry, const Props& props, double gap,
                                         const std::vector<SunkenProp>& sunken);

/// Sets the overlaps and the undecided ones.
void find_overlaps(const Geometry& geometry, const Props& props, const PartLimits& limits, PartFindings& out);

}  // namespace spawnfield
