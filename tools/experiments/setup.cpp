#include "setup.h"

#include <spawnfield/bake.h>
#include <spawnfield/output_file.h>

#include <chrono>
#include <cmath>
#include <numbers>

using namespace spawnfield;

namespace experiments {
namespace {

class Lap {
public:
    double seconds()
    {
        const auto now = std::chrono::steady_clock::now();
        const std::chrono::duration<double> lap = now - start_;
        start_ = now;
        return lap.count();
    }

private:
    std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
};

/// Returns a superellipsoid of the Husky's size as an OBJ file. Its faces do not matter, because a robot uses the
/// convex hull of a mesh. Source: Barr, Superquadrics and Angle-Preserving Transformations, 1981.
std::string husky_body()
{
    constexpr int slices = 14, rings = 7;  // rings of corners between the poles
    constexpr double exponent = 0.4;       // 1 gives an ellipsoid, 0 a box
    const auto rounded = [](double x) { return std::copysign(std::pow(std::abs(x), exponent), x); };
    std::string text;
    const auto add = [&](double up, double around) {
        text += "v " + std::to_string(0.495 * rounded(std::sin(up)) * rounded(std::cos(around))) + " " +
                std::to_string(0.335 * rounded(std::sin(up)) * rounded(std::sin(around))) + " " +
                std::to_string(0.195 - 0.195 * rounded(std::cos(up))) + "\n";
    };
    add(0, 0);
    for (int ring = 1; ring <= rings; ++ring)
        for (int slice = 0; slice < slices; ++slice)
            add(std::numbers::pi * ring / (rings + 1), 2 * std::numbers::pi * (slice + 0.5) / slices);
    add(std::numbers::pi, 0);
    for (int i = 1; i <= slices * rings; ++i)
        text += "f " + std::to_string(i) + " " + std::to_string(i + 1) + " " + std::to_string(i + 2) + "\n";
    return text;
}

}  // namespace

Environment environment(const Settings& settings, const std::string& name,
                        const std::function<worlds::World(std::uint64_t)>& make, double resolution)
{
    settings.on_step(name + ": making, baking");
    Environment out{.name = name, .map = {}, .seed = 1};
    const std::filesystem::path world_folder = settings.folder / "worlds" / name,
                                map_folder = settings.folder / "maps" / name;
    Lap lap;
    worlds::World world = make(out.seed);
    worlds::write_world(world, world_folder);
    out.landmarks = std::move(world.landmarks);
    out.make_seconds = lap.seconds();
    std::filesystem::create_directories(map_folder.parent_path());
    const std::filesystem::path scene_file = world_folder / "scene.yaml";
    bake(load_scene(scene_file), scene_file, map_folder,
         {.resolution = resolution, .allow_no_terrain = true, .threads = settings.threads});
    out.bake_seconds = lap.seconds();
    out.map = read_map(map_folder);
    out.read_seconds = lap.seconds();
    return out;
}

Environment empty_environment(int heights)
{
    Environment out{.name = "empty", .map = {}};
    out.map.name = out.name;
    out.map.bounds = {{0, 0, 0}, {9, 9, double(heights - 1)}};
    out.map.resolution = 1;
    out.map.geometry = Geometry(Scene{});
    out.map.solid_bounds = SolidBounds(out.map.geometry, out.map.bounds, out.map.resolution);
    return out;
}

Robot robot(const Settings& settings, const std::string& name)
{
    const std::filesystem::path folder = settings.folder / "robots";
    std::filesystem::create_directories(folder);
    if (name == "hull") write_file_atomically(folder / "husky_body.obj", husky_body());
    write_file_atomically(
        folder / (name + ".yaml"),
        "format: spawnfield-robot/1\nname: " + name + "\nparts:\n  - " +
            (name == "hull" ? "mesh: husky_body.obj" : "{box: [0.99, 0.67, 0.39], xyz: [0, 0, 0.195]}") + "\n");
    return load_robot((folder / (name + ".yaml")).string());
}

}  // namespace experiments
