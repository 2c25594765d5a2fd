#pragma once

#include "../temp_folder.h"
#include "report.h"

#include <spawnfield/query.h>

#include <functional>
#include <optional>

namespace bench {

/// A scene, and how much of it each stage does.
struct Setting {
    std::string name;
    std::function<spawnfield::Scene()> make;
    double cell = 0.5;  ///< of the terrain raster, m; a voxel is 2.5 cells
    double step = 1;    ///< of the 2D raster, m
    double step_3d = 1;
    std::size_t poses = 100000;    ///< to check
    std::size_t samples = 2000;
    double sample_distance = 2.5;  ///< m
    std::size_t finds = 500;       ///< valid ones of a search
    double search_distance = 2.5;  ///< m
};

enum class Extent { Quick, Usual, Full };
std::vector<Setting> settings(Extent extent);

/// One scene with all that its stages need, made when it is first asked for.
class Workbench {
public:
    explicit Workbench(const Setting& setting);

    struct Stage {
        std::string name;
        bool parallel;  ///< whether it has a number of threads
        std::function<Measurement(int threads)> run;
    };
    /// In the order in which they run; they refer to this workbench.
    std::vector<Stage> stages();

    spawnfield::BakeReport bake_into(const std::filesystem::path& folder, spawnfield::Scene scene, int threads) const;

private:
    const spawnfield::Map& map();
    const spawnfield::CollisionChecker& checker();
    const std::vector<spawnfield::Pose>& poses();

    Measurement make() const;
    Measurement geometry(int threads);
    Measurement terrain(int threads);
    Measurement occupancy(int threads);
    Measurement bake(int threads);
    Measurement read_map();
    Measurement raster_2d(double offset, int threads);
    Measurement raster_3d(int threads);
    Measurement raster(const spawnfield::RasterOptions& options);
    Measurement check(int threads);
    Measurement sample(int threads);
    Measurement search(int threads);

    const Setting setting_;
    spawnfield::Scene scene_;
    TempFolder folder_;
    std::optional<spawnfield::Map> map_;
    std::optional<spawnfield::CollisionChecker> checker_;
    std::vector<spawnfield::Pose> poses_;
};

}  // namespace bench
