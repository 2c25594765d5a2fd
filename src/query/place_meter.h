#pragma once

#include "query/clearance.h"

#include <spawnfield/place_quantities.h>

namespace spawnfield {

/// Measures the quantities of poses. Const calls may run at the same time.
class PlaceMeter {
public:
    /// Throws ArgumentError for measures beyond their limits, and for those of settled robots if the robots are level;
    /// it names `function`.
    PlaceMeter(const char* function, const Geometry& geometry, const Robot& robot, const PlaceMeasures& measures,
               bool is_settled);

    const std::vector<PlaceQuantity>& columns() const { return measures_.columns; }
    bool has_preferences() const { return !measures_.prefer.empty(); }

    /// What poses near each other share, to be faster. It does not change what is measured.
    using Neighbour = ClearanceMeter::Nearest;

    /// Returns a quantity of a valid pose. `tilt` and `margin` are those of the settled pose.
    double measure(PlaceQuantity quantity, const Pose& pose, double tilt, double margin,
                   Neighbour* neighbour = nullptr) const;
    /// Returns the density of spawns at a valid pose, as a share of the largest one that is possible, 0 .. 1.
    double preference(const Pose& pose, double margin) const;

private:
    double head_room(const Pose& pose) const;
    double roughness(const Pose& pose) const;
    double view(const Pose& pose) const;
    double most_of(PlaceQuantity quantity) const;

    const Geometry geometry_;
    const PlaceMeasures measures_;
    const ClearanceMeter clearances_;
    std::vector<Convex> bodies_;  ///< of the robot, in its frame
    const Bounds box_;            ///< of the robot, in its frame
};

}  // namespace spawnfield
