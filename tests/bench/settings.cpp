#include "workbench.h"

#include "city.h"
#include "floors.h"
#include "hills.h"
#include "town.h"
#include "worlds/lattice.h"

using namespace spawnfield;
using namespace worlds;

namespace bench {
namespace {

Scene training_scene() { return load_scene(SPAWNFIELD_SOURCE "/maps/training/scene.yaml"); }

LayerChoice top() { return {.kind = LayerChoice::Kind::Top}; }

Setting training(Extent extent)
{
    Setting out{.name = "training", .make = training_scene, .robot = husky_box, .has_rivals = false};
    const bool quick = extent == Extent::Quick;
    const double step = quick ? 0.5 : 0.1;
    out.cell = quick ? 0.25 : 0.05;
    out.step_3d = quick ? 1 : 0.2;
    out.rasters = {{"raster2d@0.1", step, 0.1}, {"raster2d@0.3", step, 0.3}, {"raster2d@1.0", step, 1.0}};
    out.poses = quick ? 1000 : 20000;
    out.sample_distance = out.search_distance = 0.1;
    if (quick) out.samples = out.finds = 50;
    return out;
}

void make_quick(Setting& setting)
{
    setting.cell = 2;
    setting.step_3d = 4;
    setting.thinning = 2;
    for (RasterWork& work : setting.rasters) work.step = 4;
    setting.poses = 1000;
    setting.samples = setting.finds = 20;
    setting.nav_points = 500;
}

Setting hills(Extent extent)
{
    Setting out{.name = "hills", .make = [] { return hills_scene(); }, .robot = husky_box};
    const double step = extent == Extent::Full ? 0.5 : 1;
    out.one_layer = true;
    out.step_3d = step;
    out.thinning = extent == Extent::Full ? 20 : 10;
    out.rasters = {{"raster2d@0.1", step, 0.1},
                   {"raster2d@0.3", step, 0.3},
                   {"raster2d@1.0", step, 1.0},
                   {"raster2d-1m@0.5", 1, 0.5},
                   {"raster2d-16-headings@0.5", 1, 0.5, {}, 16},
                   {"settled", step, 0, {}, 1, Stance::Settled},
                   {"settled-1m", 1, 0, {}, 1, Stance::Settled},
                   {"settled-16-headings", 4, 0, {}, 16, Stance::Settled}};
    if (extent == Extent::Full) {
        out.cell = 0.1;
        out.poses = 1000000;
        out.finds = 2000;
    }
    if (extent == Extent::Quick) {
        out.make = [] { return small_hills_scene(); };
        make_quick(out);
    }
    return out;
}

Setting town(Extent extent)
{
    Setting out{.name = "town", .make = [] { return town_scene(); }, .robot = husky_box};
    out.cell = extent == Extent::Full ? 0.2 : 1;
    out.step_3d = 2;
    out.thinning = 10;
    out.rasters = {{"raster2d@0.1", 2, 0.1},
                   {"raster2d@1.0", 2, 1.0},
                   {"raster2d-top@0.1", 2, 0.1, top()},
                   {"raster2d-top@1.0", 2, 1.0, top()},
                   {"raster2d-2.5m-top@0.1", 2.5, 0.1, top()}};
    if (extent == Extent::Quick) {
        out.make = [] { return small_town_scene(); };
        make_quick(out);
    }
    return out;
}

Setting city(Extent extent)
{
    Setting out{.name = "city", .make = [] { return city_scene(); }, .robot = husky_box, .has_rivals = false};
    out.cell = extent == Extent::Full ? 0.1 : 0.5;
    out.step_3d = 2;
    const double step = extent == Extent::Full ? 0.5 : 1;
    out.rasters = {{"raster2d@0.1", step, 0.1}, {"settled", step, 0, {}, 1, Stance::Settled}};
    if (extent == Extent::Quick) {
        out.make = [] { return small_city_scene(); };
        make_quick(out);
    }
    return out;
}

Setting floors(Extent extent)
{
    Setting out{.name = "floors", .make = [] { return floors_scene(); }, .robot = husky_box};
    out.cell = 0.05;
    out.step_3d = 0.25;
    out.thinning = 2;
    out.rasters = {{"raster2d@0.1", 0.1, 0.1}, {"raster2d@0.5", 0.1, 0.5}, {"raster2d-top@0.1", 0.1, 0.1, top()}};
    out.sample_distance = out.search_distance = 0.5;
    out.finds = 200;
    if (extent == Extent::Quick) {
        make_quick(out);
        out.cell = 0.5;
        out.step_3d = 1;
        for (RasterWork& work : out.rasters) work.step = 1;
    }
    return out;
}

/// Returns a setting with poses 1 m apart, starting at the origin.
Setting lattice(const std::string& name, int heights)
{
    Setting out{.name = name, .has_ground = false, .height_check = false};
    out.bounds.min = Vec3::Zero();
    out.bounds.max = {9, 9, heights - 1.0};
    return out;
}

Setting grid(bool hulls, Extent extent)
{
    const int heights = extent == Extent::Quick ? 20 : 500;
    Setting out = lattice(hulls ? "grid-hull" : "grid-box", heights);
    out.cell = 0.05;
    if (hulls) {
        out.make = [heights] { return grid_of_balls(10, 10, heights); };
        out.robot = hull_robot;
    } else {
        out.make = [heights] { return grid_of_boxes(10, 10, heights); };
        out.robot = husky_box;
    }
    return out;
}

Setting empty(Extent extent)
{
    Setting out = lattice("empty", extent == Extent::Quick ? 100 : 10000);
    out.height_check = true;
    out.make = [] { return empty_scene(); };
    out.robot = husky_box;
    return out;
}

}  // namespace

Robot husky_box() { return load_robot("box:0.99,0.67,0.39"); }

std::vector<Setting> tiled_settings(Extent extent)
{
    std::vector<Setting> out;
    for (const int side : {1, 2, 4}) {
        Setting setting{.name = "hills-" + std::to_string(side * side) + "x", .robot = husky_box};
        const bool quick = extent == Extent::Quick;
        setting.make = [side, quick] { return quick ? small_hills_scene(1, side) : hills_scene(1, side); };
        if (quick) setting.cell = 2;
        out.push_back(setting);
    }
    return out;
}

std::vector<Setting> settings(Extent extent)
{
    return {training(extent), hills(extent),       town(extent),       city(extent),
            floors(extent),   grid(false, extent), grid(true, extent), empty(extent)};
}

}  // namespace bench
