#include "common/seed.h"
#include "world.h"

#include <CLI/CLI.hpp>

#include <functional>
#include <iostream>
#include <map>

namespace {

using Make = std::function<worlds::World(std::uint64_t seed)>;

const std::map<std::string, Make>& makers()
{
    static const std::map<std::string, Make> all = {
        {"benchmark-cubes", [](std::uint64_t) { return worlds::benchmark_cubes(); }},
        {"benchmark-balls", [](std::uint64_t) { return worlds::benchmark_balls(); }},
        {"complex", [](std::uint64_t seed) { return worlds::complex_district(seed); }},
        {"complex-deck", [](std::uint64_t seed) { return worlds::complex_district(seed, worlds::Bridge::DeckAlone); }},
        {"low-complexity", [](std::uint64_t seed) { return worlds::low_complexity(seed); }},
    };
    return all;
}

}  // namespace

int main(int argc, char** argv)
{
    CLI::App app{"Makes a world from a seed: scene.yaml and its meshes, for `spawnfield bake`"};
    std::string name;
    std::filesystem::path folder;
    std::uint64_t seed = 1;
    std::vector<std::string> names;
    for (const auto& [known, make] : makers()) names.push_back(known);
    app.add_option("world", name, "Name of the world")->required()->check(CLI::IsMember(names));
    app.add_option("-o,--output", folder, "Folder of the output; it is created if it does not exist")->required();
    app.add_option("--seed", seed, "The same seed gives the same bytes; the benchmark worlds do not use it")
        ->check(tools::seed_complaint)
        ->capture_default_str();
    app.footer(
        "Example:\n  spawnfield_worlds benchmark-cubes -o /tmp/cubes\n"
        "  spawnfield bake /tmp/cubes/scene.yaml -o /tmp/cubes-map --allow-no-terrain");
    app.set_version_flag("--version", spawnfield::version());
    try {
        app.parse(argc, argv);
    } catch (const CLI::ParseError& error) {
        return app.exit(error) == 0 ? 0 : 2;  // 2 means wrong usage, as in spawnfield
    }
    try {
        worlds::write_world(makers().at(name)(seed), folder);
    } catch (const std::exception& error) {
        std::cerr << "spawnfield_worlds: " << error.what() << "\n";
        return 1;
    }
    std::cout << (folder / "scene.yaml").string() << "\n";
}
