#include "catch.h"
#include "settle/settle.h"
#include "shared_scenes.h"

#include <spawnfield/scene.h>

#include <nlohmann/json.hpp>

#include <fstream>

using namespace spawnfield;

// Tests of how a robot comes to rest on the ground.

TEST_CASE("a robot rests as the closed form says")
{
    const auto scenes = shared_scenes();
    if (!scenes) return;
    const std::filesystem::path folder = scenes->parent_path() / "standing";
    const nlohmann::json cases = nlohmann::json::parse(std::ifstream(folder / "cases.json"));
    for (const nlohmann::json& expected : cases.at("cases")) {
        INFO(expected.at("name").get<std::string>());
        const Scene scene = load_scene(folder / expected.at("scene").get<std::string>());
        const Robot robot = load_robot((folder / expected.at("robot").get<std::string>()).string());
        const Geometry geometry(scene);
        const double x = expected.at("x"), y = expected.at("y"), yaw = expected.at("yaw");
        const Column column = column_at(geometry, x, y);
        REQUIRE(!column.layers.empty());
        const Rest rest = Settler(geometry, robot, {}).settle(x, y, yaw, column.layers.front());
        CHECK(std::abs(rest.z - expected.at("z").get<double>()) <= 1e-6);
        CHECK(std::abs(rest.roll - expected.at("roll").get<double>()) <= 1e-6);
        CHECK(std::abs(rest.pitch - expected.at("pitch").get<double>()) <= 1e-6);
        CHECK((rest.state == Rest::State::Standing) == expected.at("stable").get<bool>());
        if (!expected.at("margin").is_null()) CHECK(std::abs(rest.margin - expected.at("margin").get<double>()) <= 1e-6);
    }
}
