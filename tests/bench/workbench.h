#pragma once

#include "../temp_folder.h"
#include "embree_only.h"
#include "nav_mesh.h"
#include "plain_fcl.h"
#include "report.h"

#include <spawnfield/bake.h>
#include <spawnfield/query.h>

#include <functional>
#include <optional>

namespace bench {

/// A stage that makes a 2D raster.
struct RasterWork {
    std::string name;
    double step, offset;  ///< m; settled robots have no offset
    spawnfield::LayerChoice layers = {};
    int headings = 1;  ///< the same raster at this many yaws, spread evenly over a full turn
    spawnfield::Stance stance = spawnfield::Stance::Level;
};

/// A scene, and the amount of work for each stage.
struct Setting {
    std::string name;
    std::function<spawnfield::Scene()> make = {};
    std::function<spawnfield::Robot()> robot = {};
    spawnfield::Bounds bounds = {};  ///< of the map; empty: those of the scene
    bool one_layer = false;          ///< all terrain is in the top layer, the only one that plain FCL can handle
    bool has_ground = true;          ///< false: the scene has only a 3D raster
    bool height_check = true;        ///< of the 3D raster
    bool has_rivals = true;          ///< whether alternatives (b), (c) and (d) run on this scene
    double cell = 0.5;               ///< m, of the terrain raster; a voxel is 2.5 cells
    std::vector<RasterWork> rasters = {};
    double step_3d = 1;          ///< m
    int thinning = 1;            ///< plain FCL checks only every `thinning`-th row and column of the 3D raster
    std::size_t poses = 100000;  ///< number of poses to check
    std::size_t samples = 2000;
    double sample_distance = 2.5;  ///< m
    std::size_t finds = 500;       ///< number of valid poses that a search must find
    double search_distance = 2.5;  ///< m
    std::size_t nav_points = 100000;
};

/// Returns whether a raster of level robots has top layers and one heading only. Alternatives (b) and (d) can answer
/// these.
inline bool is_top_raster(const Setting& setting, const RasterWork& work)
{
    return work.headings == 1 && work.stance == spawnfield::Stance::Level &&
           (setting.one_layer || work.layers.kind == spawnfield::LayerChoice::Kind::Top);
}
bool has_top_raster(const Setting& setting);

enum class Extent { Quick, Usual, Full };
std::vector<Setting> settings(Extent extent);
std::vector<Setting> tiled_settings(Extent extent);  ///< landscapes of 1, 4 and 16 tiles, for baking
spawnfield::Robot husky_box();                       ///< box:0.99,0.67,0.39

/// One scene with everything that its stages need. Each thing is made when it is first needed.
class Workbench {
public:
    explicit Workbench(const Setting& setting);

    using Run = std::function<Measurement(int threads)>;
    struct Rival {
        std::string name;
        Run run;
        bool has_same_result = false;  ///< its result must have the same bytes as that of the stage
    };
    struct Stage {
        std::string name;
        bool parallel;  ///< whether it uses several threads
        Run run;
        std::vector<Rival> rivals = {};
    };
    /// Returns the stages in the order in which they run. They refer to this workbench.
    std::vector<Stage> stages();

    /// Returns lines of text that compare plain FCL and Recast with spawnfield, for the stages whose name contains
    /// `only`.
    std::vector<std::string> comparisons(const std::string& only);

    spawnfield::BakeReport bake_into(const std::filesystem::path& folder, spawnfield::Scene scene, int threads) const;

private:
    const spawnfield::Scene& scene();
    const spawnfield::Map& map();
    const spawnfield::Judge& judge();
    const spawnfield::Judge& exhaustive_judge();  ///< alternative (a): every pose decided by FCL, none by the mask
    const PlainFcl& plain_fcl();
    const NavMesh& nav_mesh();
    const EmbreeOnly& embree_only();
    const std::vector<spawnfield::Pose>& poses();
    bool is_top_raster(const RasterWork& work) const { return bench::is_top_raster(setting_, work); }
    bool has_embree_only() const;  ///< whether alternative (d) runs on this scene
    bool has_plain_fcl() const { return setting_.has_rivals && PlainFcl::is_available(); }
    bool has_nav_mesh() const { return setting_.has_rivals && setting_.has_ground && NavMesh::is_available(); }

    void add_bakes(std::vector<Stage>& out);
    void add_rasters(std::vector<Stage>& out);
    void add_top_rivals(const RasterWork& work, Stage& stage);
    void add_headings(const RasterWork& work, std::vector<Stage>& out);
    void add_spawns(std::vector<Stage>& out);
    void add_set_ups(std::vector<Stage>& out);

    Measurement make() const;
    Measurement geometry(int threads);
    Measurement terrain(int threads);
    Measurement occupancy(int threads);
    Measurement bake(int threads);
    Measurement read_map();
    Measurement raster(const spawnfield::Judge& judge, const spawnfield::RasterOptions& options);
    Measurement raster_headings(const spawnfield::RasterOptions& options, int headings);
    Measurement check(const spawnfield::Judge& judge, int threads);
    Measurement sample(const spawnfield::Judge& judge, const spawnfield::SampleOptions& options);
    Measurement search(const spawnfield::Judge& judge, const spawnfield::SearchOptions& options);
    /// Measures a 2D raster of an alternative: `make(grid)` returns a TopRaster.
    template <class Make>
    Measurement rival_raster_2d(const RasterWork& work, const Make& make);
    Measurement fcl_raster_3d(int threads);
    Measurement fcl_check(int threads);
    Measurement nav_draw();

    spawnfield::RasterOptions options_2d(const RasterWork& work) const;
    spawnfield::RasterOptions options_3d() const;
    /// Returns the options of the 3D raster with only every `thinning`-th row and column.
    spawnfield::RasterOptions thinned_options_3d() const;
    spawnfield::SampleOptions sample_options() const;
    spawnfield::SearchOptions search_options() const;

    void compare_2d(const RasterWork& work, std::vector<std::string>& out);
    std::string compare_3d();
    std::string compare_checks();
    std::string compare_nav_mesh();
    std::string coverage();
    std::string shares(const std::vector<spawnfield::Pose>& asked);

    const Setting setting_;
    TempFolder folder_;
    std::optional<spawnfield::Scene> scene_;
    std::optional<spawnfield::Map> map_;
    std::optional<spawnfield::Judge> judge_, exhaustive_judge_;
    std::unique_ptr<const PlainFcl> plain_fcl_;
    std::unique_ptr<const NavMesh> nav_mesh_;
    std::unique_ptr<const EmbreeOnly> embree_only_;
    std::vector<spawnfield::Pose> poses_;
};

/// How often a stage and its rivals run, each of them once in every round: `most` times if that takes less than 5 s,
/// because few runs of some milliseconds are noise, and at least `least` times.
struct Rounds {
    int least, most;
};

/// Runs a stage and its rivals (named "stage rival"), each once untimed and then in turns. If a run takes longer than
/// 10 s it is not repeated, and its first time counts. Throws std::runtime_error if results differ that must be the
/// same.
std::vector<Row> run_in_turns(const std::string& scene, const Workbench::Stage& stage, int threads, Rounds rounds);

}  // namespace bench
