#pragma once

#include "common_args.h"
#include "host.h"

#include <spawnfield/fleet.h>
#include <spawnfield/pairs.h>
#include <spawnfield/poses.h>
#include <spawnfield/query.h>
#include <spawnfield/repair.h>

#include <memory>
#include <optional>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

/// What the commands find. A command leaves a std::shared_ptr<const T> of one of these types in Host::result, for a
/// caller that uses the values in place of files.
namespace spawnfield::cli {

/// Of `sample` and `search`.
struct FoundSpawns {
    SpawnList list;
};

/// Of `sample --pairs`.
struct FoundPairs {
    PairList list;
    double lift = 0;  ///< m, by which the poses in files are raised
};

/// Of `sample --fleet` and `sample --fill`.
struct FoundFleet {
    Fleet fleet;
    std::vector<std::string> kinds;
};

/// Of `raster`.
struct FoundRaster {
    RasterResult raster;
};

/// Of `check`.
struct FoundVerdicts {
    PoseTable table;
    std::vector<Judgement> judgements;  ///< one for each pose
    std::vector<SettledPose> settled;   ///< one for each pose; empty for poses as given
    std::optional<RepairList> repairs;
    Judge judge;  ///< that judged them
};

/// Of `review`, if it is asked for new layers or poses of an open page (Host::wants_update).
struct FoundUpdate {
    std::string pack;
};

/// Leaves a result in the host.
template <class T>
void keep(const CommonArgs& args, T&& found)
{
    args.host->result = std::make_shared<const std::remove_cvref_t<T>>(std::forward<T>(found));
}

}  // namespace spawnfield::cli
