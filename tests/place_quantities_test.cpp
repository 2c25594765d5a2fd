#include "arena.h"
#include "test_map.h"
#include "this_build.h"

#include <spawnfield/place_quantities.h>
#include <spawnfield/robot_parts.h>
#include <spawnfield/scene_parts.h>

using namespace spawnfield;

namespace {

constexpr double half_x = 0.4, half_y = 0.25, robot_height = 0.3, offset = 0.1;
constexpr double wall_x = 3, table_bottom = 1;

/// The origin is in the middle of the robot's bottom.
Robot low_robot()
{
    return make_robot("low",
                      {shape_part(box_shape({2 * half_x, 2 * half_y, robot_height}, {{0, 0, robot_height / 2}}))});
}

/// Returns a floor of 12 x 12 m with a wall across it and the top of a table without legs, with its middle at (-3, -3).
TestMap hall()
{
    Scene scene;
    add_shape(scene, "floor", Label::Terrain, box_shape({12, 12, 0.2}, {{0, 0, -0.1}}));
    add_shape(scene, "wall", Label::Obstacle, box_shape({0.2, 12, 2}, {{wall_x + 0.1, 0, 1}}));
    add_shape(scene, "table", Label::Obstacle, box_shape({2, 2, 0.1}, {{-3, -3, table_bottom + 0.05}}));
    return map_of(std::move(scene));
}

SampleOptions level(std::vector<PlaceQuantity> columns, double yaw, std::size_t count = 300)
{
    SampleOptions out{.count = count, .yaw = yaw, .seed = 7, .stance = Stance::Level};
    out.bounds = {Vec3(-5, -3.5, 0), Vec3(5, 3.5, 0)};
    out.measures.columns = std::move(columns);
    return out;
}

}  // namespace

TEST_CASE("clearance, head room and view of spawns in a hall are those of the drawing")
{
    const Judge judge(hall(), low_robot());
    SECTION("clearance")
    {
        const double yaw = 0.4, half = half_x * std::cos(yaw) + half_y * std::sin(yaw);
        const SpawnList list = sample(judge, level({PlaceQuantity::Clearance}, yaw));
        REQUIRE(list.columns.size() == 1);
        for (std::size_t i = 0; i < list.spawns.size(); ++i) {
            const double x = list.spawns[i].position.x(), gap = x < wall_x ? wall_x - x : x - wall_x - 0.2;
            CHECK(list.columns[0].values[i] == Approx(gap - half).margin(1e-8));
        }
    }
    SECTION("head room")
    {
        const SpawnList list = sample(judge, level({PlaceQuantity::HeadRoom}, 0));
        std::size_t below = 0;
        for (std::size_t i = 0; i < list.spawns.size(); ++i) {
            const Vec3& at = list.spawns[i].position;
            const bool is_below = std::abs(at.x() + 3) < 1 + half_x && std::abs(at.y() + 3) < 1 + half_y;
            CHECK(list.columns[0].values[i] ==
                  Approx(is_below ? table_bottom - offset - robot_height : 10).margin(1e-5));
            below += is_below;
        }
        CHECK(below > 10);
    }
    SECTION("view")
    {
        SampleOptions options = level({PlaceQuantity::View}, 0);
        options.measures.view_range = 2;
        const SpawnList list = sample(judge, options);
        std::set<double> shares;
        for (std::size_t i = 0; i < list.spawns.size(); ++i) {
            const double x = list.spawns[i].position.x(), way = x < wall_x ? wall_x - x : x - wall_x - 0.2;
            int clear = 0;
            for (int k = 0; k < 64; ++k) {
                const double forth = std::cos(2 * std::numbers::pi * k / 64) * (x < wall_x ? 1 : -1);
                clear += !(forth > 0 && way <= 2 * forth);
            }
            CHECK(list.columns[0].values[i] == clear / 64.0);
            shares.insert(list.columns[0].values[i]);
        }
        CHECK(shares.size() > 10);
        options.measures.sensor_height = table_bottom - offset + 0.05;  // as high as the table: now it is in the way
        CHECK(sample(judge, options).columns[0].values != list.columns[0].values);
    }
}

TEST_CASE("roughness is the deviation of the ground from the line that fits it best")
{
    constexpr double step = 0.05;
    Scene scene;
    add_shape(scene, "low", Label::Terrain, box_shape({4, 8, 0.2}, {{-2, 0, -0.1}}));
    add_shape(scene, "high", Label::Terrain, box_shape({4, 8, 0.2}, {{2, 0, -0.1 + step}}));
    const Judge judge(map_of(std::move(scene)), low_robot());
    SampleOptions options = level({PlaceQuantity::Roughness}, 0, 1000);
    options.bounds = {Vec3(-1, -3, 0), Vec3(1, 3, 0)};
    const SpawnList list = sample(judge, options);
    std::size_t rough = 0;
    for (std::size_t i = 0; i < list.spawns.size(); ++i) {
        std::array<double, 9> heights{};
        double mean = 0, slope = 0, squares = 0;
        bool is_near_step = false;
        for (std::size_t k = 0; k < 9; ++k) {
            const double x = list.spawns[i].position.x() + (double(k) - 4) * half_x / 4;
            is_near_step |= std::abs(x) < 1e-6;
            heights[k] = x > 0 ? step : 0;
            mean += heights[k] / 9;
            slope += heights[k] * (double(k) - 4) / 60;  // 60: sum of the squares of -4 .. 4
        }
        for (std::size_t k = 0; k < 9; ++k) squares += std::pow(heights[k] - mean - slope * (double(k) - 4), 2);
        if (is_near_step) continue;
        CHECK(list.columns[0].values[i] == Approx(std::sqrt(squares / 9)).margin(1e-9));
        rough += squares > 1e-6;
    }
    CHECK(rough > 100);
}

TEST_CASE("a robot that is raised by its head room touches something by FCL, and nothing before, in random scenes")
{
    constexpr double near = 1e-4;
    std::size_t met = 0, open = 0;
    for (std::uint64_t seed = 1; seed <= 8; ++seed) {
        const TestMap map = map_of(random_scene(seed));
        const Judge judge(map, random_robot(seed));
        const CollisionChecker checker = checker_of(map, judge.robot());
        SampleOptions options{.count = 60, .random_yaw = true, .seed = seed, .stance = Stance::Level};
        options.measures.columns = {PlaceQuantity::HeadRoom};
        const SpawnList list = sample(judge, options);
        for (std::size_t i = 0; i < list.spawns.size(); ++i) {
            const double room = list.columns[0].values[i];
            const auto is_free = [&](double rise) {
                return checker.is_free(
                    {list.spawns[i].position + rise * Vec3::UnitZ(), rotation_from_rpy(0, 0, list.spawns[i].yaw)});
            };
            for (int k = 0; k <= 20 && room > near; ++k) CHECK(is_free((room - near) * k / 20));
            if (room < 10) CHECK_FALSE(is_free(room + 1e-6));
            ++(room < 10 ? met : open);
        }
    }
    CHECK(met > 20);
    CHECK(open > 20);
}

TEST_CASE("the density of preferred spawns is proportional to the preferred quantities")
{
    constexpr std::size_t count = 20000, bins = 20;
    const Judge judge(hall(), low_robot());
    SampleOptions options = level({PlaceQuantity::Clearance, PlaceQuantity::HeadRoom}, 0, count);
    const SpawnList uniform = sample(judge, options);
    const auto bin_of = [](double clearance) { return std::min(bins - 1, std::size_t(clearance / 8 * bins)); };
    const double weight = GENERATE(1.0, 0.5);
    std::array<double, bins> expected{};
    double sum = 0;
    for (std::size_t i = 0; i < count; ++i) {
        const double factor = std::pow(uniform.columns[0].values[i], weight) * uniform.columns[1].values[i];
        expected[bin_of(uniform.columns[0].values[i])] += factor;
        sum += factor;
    }
    const auto differing = [&](const SpawnList& list) {
        std::array<double, bins> found{};
        for (const double clearance : list.columns[0].values) ++found[bin_of(clearance)];
        std::size_t out = 0;
        for (std::size_t k = 0; k < bins; ++k) {
            const double wanted = expected[k] * count / sum;
            out += std::abs(found[k] - wanted) > 6 * std::sqrt(3 * wanted) + 5;  // both lists are random
        }
        return out;
    };
    options.measures.prefer = {{PlaceQuantity::Clearance, weight}, {PlaceQuantity::HeadRoom, 1}};
    options.seed = 8;
    const SpawnList preferred = sample(judge, options);
    REQUIRE(preferred.spawns.size() == count);
    CHECK(preferred.not_preferred > count / 4);
    CHECK(differing(preferred) == 0);
    CHECK(differing(uniform) > 2);
}

TEST_CASE("measured and preferred spawns have the same bytes with 1, 2 and 8 threads")
{
    const Judge judge(training_map(), husky());
    SampleOptions options{.count = is_slow_build() ? 50u : 200u, .seed = 2};
    options.measures = {
        .columns = {all_place_quantities.begin(), all_place_quantities.end() - 1},  // room needs a graph: path_test.cpp
        .prefer = {{PlaceQuantity::Clearance, 0.5}, {PlaceQuantity::Margin, 1}, {PlaceQuantity::View, 1}}};
    std::set<std::string> texts;
    for (const int threads : {1, 2, 8}) {
        options.threads = threads;
        texts.insert(spawns_csv(sample(judge, options)));
    }
    CHECK(texts.size() == 1);
    CHECK(texts.begin()->starts_with("x,y,z,roll,pitch,yaw,tilt,margin,clearance,head_room,roughness,view\n"));

    // Without preferences, the columns change no spawn; tilt and margin are those of the rests.
    options.measures.prefer.clear();
    const SpawnList with = sample(judge, options);
    options.measures.columns.clear();
    const SpawnList without = sample(judge, options);
    for (std::size_t i = 0; i < with.spawns.size(); ++i) {
        CHECK(with.spawns[i].position == without.spawns[i].position);
        CHECK(with.columns[2].values[i] == with.rests[i].tilt);
        CHECK(with.columns[3].values[i] == with.rests[i].margin);
    }
}

TEST_CASE("wrong quantities are refused")
{
    const Judge judge(hall(), low_robot());
    const auto with = [&](const PlaceMeasures& measures) {
        SampleOptions options = level({}, 0);
        options.measures = measures;
        return sample(judge, options);
    };
    CHECK_THROWS_WITH(with({.columns = {PlaceQuantity::Tilt}}), Contains("tilt is only known of settled robots"));
    CHECK_THROWS_WITH(with({.columns = {PlaceQuantity::Clearance, PlaceQuantity::Clearance}}),
                      Contains("clearance is given twice"));
    CHECK_THROWS_WITH(with({.prefer = {{PlaceQuantity::Roughness, 1}}}), Contains("of which less is better"));
    CHECK_THROWS_WITH(with({.prefer = {{PlaceQuantity::View, 0}}}), Contains("prefer.weight is 0, needs > 0"));
    CHECK_THROWS_WITH(with({.columns = {PlaceQuantity::Room}}), Contains("room is only known of settled robots"));
    CHECK_THROWS_WITH(sample(judge, {.measures = {.columns = {PlaceQuantity::Room}}}),
                      "sample: the quantity room needs measures.room, for example room_on(graph, range)");
    CHECK_THROWS_WITH(with({.view_range = 0}), Contains("view_range is 0, needs > 0 m"));

    const Arena arena;
    const auto complaint = [&](const std::string& more) {
        const ProgramRun run = arena("sample map -n 5 -o out.csv" + husky_option + more);
        CHECK(run.status == 2);
        CHECK(arena.names().count("out.csv") == 0);
        return run.err;
    };
    CHECK_THAT(complaint("--columns clearance,height"), Contains("--columns has \"height\", needs one of clearance"));
    CHECK_THAT(complaint("--prefer clearance"), Contains("needs QUANTITY=WEIGHT"));
    CHECK_THAT(complaint("--prefer clearance=-1"), Contains("needs > 0"));
    CHECK_THAT(complaint("--view-range 5"), Contains("--view-range is only for"));
    CHECK_THAT(complaint("--room-range 5"), Contains("--room-range is only for --columns room and --prefer room="));
    CHECK_THAT(complaint("--columns room --room-range 500"), Contains("--room-range is 500, needs at most 100 m"));
    CHECK_THAT(complaint("--columns room --stance level"), Contains("room is only known of settled robots"));
    CHECK_THAT(complaint("--sensor-height 5"), Contains("--sensor-height is only for"));
    const ProgramRun room = arena("sample map -n 5 --columns room --room-range 2 --reach-step 0.3" + husky_option);
    CHECK(room.status == 0);
    CHECK_THAT(room.out, Contains(",margin,room\n"));
    const ProgramRun run = arena("sample map -n 5" + husky_option +
                                 "--format json --columns view,roughness --prefer clearance=2");
    CHECK(run.status == 0);
    for (const char* text : {"\"view\": ", "\"roughness\": ", "\"view_range\": 10.0", "\"clearance\": 2.0"})
        CHECK_THAT(run.out, Contains(text));
}
