#pragma once

#include "query/area_index.h"
#include "query/avoid_index.h"

#include <spawnfield/fleet.h>

#include <optional>
#include <string>
#include <vector>

namespace spawnfield {

/// A valid pose of a robot.
struct Stand {
    Spawn spawn;
    SpawnRest rest = {};
    double ground = 0;  ///< m: height of the layer; of a drawn pose, that of the ground below its origin
};

/// A valid pose, or why there is none.
struct Standing {
    std::optional<Stand> stand = {};
    std::string why = {};  ///< in words for the user
    std::uint64_t exact_checks = 0;
};

/// The work was stopped (FleetOptions::stop).
struct FleetStopped {};

/// Finds valid poses of a kind of robot, whatever other robots there are.
class KindPoses {
public:
    KindPoses(const FleetKind& kind, const FleetOptions& options);

    static constexpr std::size_t random_headings = 16;  ///< of rasters, for a random yaw

    /// Returns `count` drawn poses, or fewer if sample() finds fewer or the work is stopped. With a yaw, in place of
    /// that of the options.
    std::vector<Stand> draw(std::size_t count, std::uint64_t stream, FleetKindResult& result) const;
    /// The same for the first robot of a formation: at this yaw, or at a random one.
    std::vector<Stand> draw(std::size_t count, std::uint64_t stream, FleetKindResult& result,
                            const std::optional<double>& yaw) const;

    double step() const { return step_; }                      ///< of the raster, m
    std::size_t headings() const { return headings_.size(); }  ///< of the raster

    /// Returns the valid poses of the raster at a heading that avoid the points of the options. Counts them in `proof`.
    /// Throws FleetStopped.
    std::vector<Stand> raster(std::size_t heading, FleetProof& proof, FleetKindResult& result) const;
    std::vector<Stand> raster_at(double yaw, FleetProof& proof, FleetKindResult& result) const;

    /// Returns the pose at a place of a formation.
    Standing stand_at(const FormationSlot& slot) const;

private:
    struct Heading {
        double yaw = 0;
        std::optional<HeadingRule> rule = {};
    };
    static std::vector<Heading> headings_of(const SampleOptions& spawns);
    std::vector<Stand> drawn(const SampleOptions& options, FleetKindResult& result) const;
    Progress raster_progress() const;
    std::vector<Stand> raster_of(const Heading& heading, FleetProof& proof, FleetKindResult& result) const;
    std::optional<double> layer_at(const FormationSlot& slot) const;

    const FleetKind& kind_;
    const FleetOptions& options_;
    const AreaIndex area_;
    const AvoidIndex avoided_;
    const double step_;
    const std::vector<Heading> headings_;

    friend double auto_fill_step(const FleetKind& kind);
};

}  // namespace spawnfield
