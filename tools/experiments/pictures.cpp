#include "pictures.h"

#include <spawnfield/heatmap.h>

#include <algorithm>
#include <stdexcept>

using namespace spawnfield;

namespace experiments {
namespace {

constexpr int case_pixels = 640, map_pixels = 560;
constexpr double columns_across =
    320;  // number of columns across the longer side, in the rasters that the pictures show

struct Case {
    const char* landmark;
    const char* title;
};

Bounds region_of(const Environment& environment, const std::string& name)
{
    for (const worlds::Landmark& landmark : environment.landmarks)
        if (landmark.name == name) return landmark.where;
    throw std::runtime_error("the environment " + environment.name + " has no landmark named " + name);
}

RasterResult verdicts_in(const Settings& settings, const Environment& environment, const Bounds& bounds, double offset)
{
    return raster(Judge(environment.map, robot(settings, "box")),
                  {.step = (bounds.max - bounds.min).head<2>().maxCoeff() / columns_across,
                   .bounds = bounds,
                   .offset = offset,
                   .threads = settings.threads});
}

Picture draw_case(const Settings& settings, const Environment& environment, const Case& shown,
                  const std::filesystem::path& folder)
{
    const RasterResult verdicts = verdicts_in(settings, environment, region_of(environment, shown.landmark), 0.3);
    const Robot box = robot(settings, "box");
    Picture picture{std::string("case_") + environment.name + "_" + shown.landmark + ".png", shown.title};
    std::replace(picture.file.begin(), picture.file.end(), '-', '_');
    write_heatmap(environment.map, read_terrain(environment.map), verdicts,
                  {.pixels = case_pixels, .title = shown.title, .robot = &box}, folder / picture.file);
    return picture;
}

}  // namespace

std::vector<Picture> draw_cases(const Settings& settings, const Districts& districts, const Environment& bridge_deck,
                                const std::filesystem::path& folder)
{
    settings.on_step("pictures of special cases");
    std::vector<Picture> out;
    for (const Case& shown : {Case{"fountain", "the fountain on the square"}, Case{"lake", "open ground and lake"},
                              Case{"dense_forest", "dense forest"}})
        out.push_back(draw_case(settings, districts.low, shown, folder));
    for (const Case& shown : {Case{"car", "an abandoned car"}, Case{"fence_and_water", "fence and water"},
                              Case{"bridge", "the bridge, frames and pillars of one object with the deck"}})
        out.push_back(draw_case(settings, districts.complex, shown, folder));
    out.push_back(draw_case(settings, bridge_deck, {"bridge", "the bridge, its deck alone terrain"}, folder));
    return out;
}

std::vector<Picture> draw_spawns(const Settings& settings, const Districts& districts,
                                 const std::filesystem::path& folder)
{
    settings.on_step("pictures of random spawns");
    std::vector<Picture> out;
    for (const int test : {7, 8}) {
        const Environment& environment = test == 7 ? districts.low : districts.complex;
        const Robot box = robot(settings, "box");
        HeatmapOptions options{
            .pixels = map_pixels, .spawns = first_search(settings, districts, test).spawns, .robot = &box};
        options.title = environment.name + ", " + std::to_string(options.spawns.size()) + " random spawns";
        Picture picture{"spawns_" + environment.name + ".png", options.title};
        std::replace(picture.file.begin(), picture.file.end(), '-', '_');
        write_heatmap(environment.map, read_terrain(environment.map),
                      verdicts_in(settings, environment, environment.map.bounds, 1.0), options, folder / picture.file);
        out.push_back(picture);
    }
    return out;
}

}  // namespace experiments
