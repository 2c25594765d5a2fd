#include "arena.h"
#include "test_map.h"

#include "query/parts_near.h"
#include "query/sight.h"
#include "scene/mesh.h"
#include "settle/convex_distance.h"

#include <spawnfield/robot_parts.h>
#include <spawnfield/scene_parts.h>

using namespace spawnfield;

namespace {

constexpr double infinite = std::numeric_limits<double>::infinity();
using Point = Eigen::Vector2d;
using Corners = std::vector<Point>;

const Point shelf_low(0, 0.2), shelf_high(2, 0.8), robot_half(0.4, 0.25);

/// Returns a floor with a shelf that reaches from the floor to above the robot. The robot's origin is at its bottom.
TestMap shelf_map()
{
    Scene scene;
    add_shape(scene, "floor", Label::Terrain, box_shape({12, 12, 0.2}, {{0, 0, -0.1}}));
    const Point size = shelf_high - shelf_low, middle = (shelf_low + shelf_high) / 2;
    add_shape(scene, "hall::shelf_1::board", Label::Obstacle,
              box_shape({size.x(), size.y(), 1.5}, {{middle.x(), middle.y(), 0.75}}));
    return map_of(std::move(scene));
}

Robot box_robot()
{
    return make_robot("box", {shape_part(box_shape({2 * robot_half.x(), 2 * robot_half.y(), 0.3}, {{0, 0, 0.15}}))});
}

Corners rectangle(const Point& low, const Point& high) { return {low, {high.x(), low.y()}, high, {low.x(), high.y()}}; }

/// Returns the corners of the robot, seen from above.
Corners footprint(const Spawn& spawn)
{
    Corners out = rectangle(-robot_half, robot_half);
    for (Point& corner : out) corner = Eigen::Rotation2Dd(spawn.yaw) * corner + spawn.position.head<2>();
    return out;
}

/// Returns the distance between two convex polygons that do not overlap: it is that of a corner from a side.
double polygon_distance(const Corners& a, const Corners& b)
{
    double out = infinite;
    for (const auto& [corners, sides] : {std::pair(&a, &b), std::pair(&b, &a)})
        for (const Point& p : *corners)
            for (std::size_t k = 0; k < sides->size(); ++k) {
                const Point from = (*sides)[k], way = (*sides)[(k + 1) % sides->size()] - from;
                const double share = std::clamp((p - from).dot(way) / way.squaredNorm(), 0.0, 1.0);
                out = std::min(out, (from + share * way - p).norm());
            }
    return out;
}

double shelf_distance(const Spawn& spawn)
{
    return polygon_distance(footprint(spawn), rectangle(shelf_low, shelf_high));
}

SampleOptions options_with(const PlaceRules& rules, std::size_t count = 300)
{
    return {.count = count, .seed = 3, .place = rules};
}

/// A convex body as a part of a robot and as a shape of a scene.
Shape random_shape(Random& random, const Vec3& at)
{
    const Mat3 rotation = rotation_of_rpy(random.between(-3, 3), random.between(-1.5, 1.5), random.between(-3, 3));
    const auto length = [&] { return std::exp(random.between(-4, 1)); };
    const ShapeKind kind = std::array{ShapeKind::Box, ShapeKind::Sphere, ShapeKind::Cylinder,
                                      ShapeKind::Capsule}[std::size_t(random.between(0, 3.999))];
    return {kind, {length(), length(), length()}, {at, rotation}};
}

/// Returns a mesh of one node: level ground, road where x < 0, and sidewalk where x > 0.
FileMesh road_and_sidewalk()
{
    return {.nodes = {{.name = "town",
                       .vertices = {{-6, -2, 0}, {0, -2, 0}, {6, -2, 0}, {-6, 2, 0}, {0, 2, 0}, {6, 2, 0}},
                       .triangles = {{0, 1, 4}, {1, 2, 5}, {0, 4, 3}, {1, 5, 4}},
                       .materials = {0, 1, 0, 1}}},
            .materials = {"road", "sidewalk"},
            .notices = {}};
}

Vec3 random_direction(Random& random)
{
    const double z = random.between(-1, 1), turn = random.between(0, 2 * std::numbers::pi), r = std::sqrt(1 - z * z);
    return {r * std::cos(turn), r * std::sin(turn), z};
}

}  // namespace

TEST_CASE("the shortest way between two bodies is the shortest shift with which FCL finds that they touch")
{
    constexpr double near = 1e-4;  // m; FCL decides with a margin of 1e-6 m
    Random random(1);
    std::size_t apart = 0, together = 0;
    for (int n = 0; n < 300; ++n) {
        const Shape a = random_shape(random, Vec3::Zero());
        Scene scene;
        Convex b;
        const Vec3 at = random.between(0.1, 4) * random_direction(random);
        if (n % 3 == 0) {
            std::array<Vec3, 3> corners;
            for (Vec3& corner : corners) corner = at + std::exp(random.between(-5, 1)) * random_direction(random);
            add_mesh(scene, "b", Label::Obstacle, {corners.begin(), corners.end()}, {{0, 1, 2}});
            b = convex_of(corners);
        } else {
            const Shape shape = random_shape(random, at);
            add_shape(scene, "b", Label::Obstacle, shape);
            b = convex_of(shape);
        }
        const CollisionChecker checker(Geometry(scene), make_robot("a", {shape_part(a)}), true);
        const Vec3 way = shortest_way(convex_of(a), b), back = shortest_way(b, convex_of(a));
        CHECK(std::abs(way.norm() - back.norm()) < 1e-8);
        if (way.norm() == 0) {
            ++together;
            CHECK_FALSE(checker.is_free({}));
            continue;
        }
        if (way.norm() < 2 * near) continue;
        ++apart;
        CHECK_FALSE(checker.is_free({way * (1 + 1e-9)}));
        CHECK(checker.is_free({way * (1 - near / way.norm())}));
        for (int k = 0; k < 20; ++k) CHECK(checker.is_free({(way.norm() - near) * random_direction(random)}));
    }
    CHECK(apart > 100);
    CHECK(together > 30);
}

TEST_CASE("the way to some parts is the shortest to all of their triangles and shapes, in random scenes")
{
    std::size_t found = 0, none = 0;
    for (std::uint64_t seed = 1; seed <= 6; ++seed) {
        Scene scene = random_scene(seed);
        Random random(seed);
        for (std::uint32_t part = 0; part < scene.parts.size(); ++part)  // two face groups of each part
            for (int k = 0; k < 2; ++k) scene.face_groups.push_back({part, "", "", {}, 0, 0});
        for (const std::uint32_t piece : scene.triangle_pieces)
            scene.triangle_groups.push_back(
                random.between(0, 1) < 0.2 ? 0 : 2 * scene.pieces[piece].part + (random.between(0, 1) < 0.5 ? 1 : 2));
        const Geometry geometry(scene);
        const Robot robot = random_robot(seed);
        Selection parts{std::vector<std::uint8_t>(scene.parts.size()),
                        std::vector<std::uint8_t>(scene.face_groups.size())};
        for (std::uint8_t& flag : parts.parts) flag = random.between(0, 1) < 0.2;
        for (std::uint8_t& flag : parts.groups) flag = random.between(0, 1) < 0.2;
        const PartsNear near(geometry, parts);
        for (const Pose& pose : random_poses(scene, seed, 40)) {
            std::vector<Convex> bodies, solids;
            for (const RobotPart& part : robot.parts)
                bodies.push_back(moved(convex_of(part), {Vec3::Zero(), pose.rotation}));
            const Pose back{-pose.position, Mat3::Identity()};
            for (std::size_t t = 0; t < scene.triangles.size(); ++t) {
                const std::uint32_t part = scene.pieces[scene.triangle_pieces[t]].part;
                if (!parts.contains(part, scene.triangle_groups[t])) continue;
                const auto& [i, j, k] = scene.triangles[t];
                solids.push_back(
                    moved(convex_of(std::array{scene.vertices[i], scene.vertices[j], scene.vertices[k]}), back));
            }
            for (const Primitive& primitive : scene.primitives)
                if (parts.parts[primitive.part] != 0) solids.push_back(moved(convex_of(primitive.shape), back));
            double least = infinite;
            for (const Convex& body : bodies)
                for (const Convex& solid : solids) least = std::min(least, shortest_way(body, solid).norm());
            for (const double most : {0.4, 3.0, infinite}) {
                const std::optional<Vec3> way = near.way_from(bodies, pose.position, most);
                if (std::abs(least - most) < 1e-6) continue;
                REQUIRE(way.has_value() == (least <= most && !solids.empty()));
                if (way) CHECK(std::abs(way->norm() - least) < 1e-6);
                ++(way ? found : none);
            }
        }
    }
    CHECK(found > 100);
    CHECK(none > 50);
}

TEST_CASE("a line is clear if FCL finds that nothing touches a thin capsule along it, in random scenes")
{
    constexpr double radius = 1e-5;  // m
    std::size_t clear = 0, blocked = 0;
    for (std::uint64_t seed = 1; seed <= 8; ++seed) {
        const Scene scene = random_scene(seed);
        const Geometry geometry(scene);
        const auto body = [&](const Shape& shape) {
            return CollisionChecker(geometry, make_robot("thin", {shape_part(shape)}));
        };
        const CollisionChecker point = body(sphere_shape(0.01, Vec3::Zero()));
        const std::vector<Pose> poses = random_poses(scene, seed, 80);
        for (std::size_t i = 0; i + 1 < poses.size(); ++i) {
            const Vec3 from = poses[i].position, to = poses[i + 1].position;
            if (!point.is_free({from}) || !point.is_free({to})) continue;
            const Vec3 way = to - from;
            const Mat3 rotation = Eigen::Quaterniond::FromTwoVectors(Vec3::UnitZ(), way).toRotationMatrix();
            const auto is_free = [&](double thick) {
                return body(capsule_shape(thick, way.norm())).is_free({(from + to) / 2, rotation});
            };
            const bool is_clear = is_clear_line(geometry, from, to);
            CHECK(is_clear == is_clear_line(geometry, to, from));
            if (is_clear)
                CHECK((is_free(radius) || is_free(radius / 100)));
            else
                CHECK_FALSE(is_free(radius));
            ++(is_clear ? clear : blocked);
        }
    }
    CHECK(clear > 30);
    CHECK(blocked > 30);
}

TEST_CASE("spawns near a shelf have that distance from it, and no place is missed")
{
    const Judge judge(shelf_map(), box_robot());
    const double low = 0.5, high = 1;
    SECTION("at random yaws")
    {
        const Stance stance = GENERATE(Stance::Level, Stance::Settled);
        SampleOptions options = options_with({.near = {{"SHELF*", low, high}}});
        options.random_yaw = true;
        options.stance = stance;
        const SpawnList list = sample(judge, options);
        REQUIRE(list.spawns.size() == options.count);
        double least = infinite, most = 0;
        for (const Spawn& spawn : list.spawns) {
            least = std::min(least, shelf_distance(spawn));
            most = std::max(most, shelf_distance(spawn));
        }
        CHECK(least >= low - 1e-6);
        CHECK(most <= high + 1e-6);
        CHECK(least < low + 0.02);
        CHECK(most > high - 0.02);
        CHECK(list.off_rules > 0);
        CHECK(list.draws < 12 * options.count);  // the floor has 144 m2, the places about 5 m2
    }
    SECTION("uniformly by area at one yaw")
    {
        constexpr double bin = 0.1;
        constexpr int bins = 120;
        SampleOptions options = options_with({.near = {{"shelf*", low, high}}}, 40000);
        options.yaw = 0.4;
        options.stance = Stance::Level;
        std::vector<int> counts(bins * bins);
        for (const Spawn& spawn : sample(judge, options).spawns)
            ++counts[std::size_t(int((spawn.position.y() + 6) / bin) * bins + int((spawn.position.x() + 6) / bin))];
        const auto holds = [&](double x, double y) {
            const double distance = shelf_distance({.position = {x, y, 0}, .yaw = options.yaw});
            return distance >= low && distance <= high && x > shelf_low.x() - 2 &&
                   !(x > 0.5 && x < 1.5 && y > 0.3 && y < 0.7);
        };
        double area = 0;
        std::vector<std::size_t> full;
        for (int row = 0; row < bins; ++row)
            for (int col = 0; col < bins; ++col) {
                int held = 0;
                for (int k = 0; k < 64; ++k)
                    held += holds(-6 + (col + (k % 8 + 0.5) / 8) * bin, -6 + (row + (double(k / 8) + 0.5) / 8) * bin);
                area += held / 64.0 * bin * bin;
                if (held == 64) full.push_back(std::size_t(row * bins + col));
            }
        REQUIRE(full.size() > 200);
        const double expected = double(options.count) * bin * bin / area;
        for (const std::size_t k : full) CHECK(std::abs(counts[k] - expected) < 6 * std::sqrt(expected));
    }
    SECTION("with an open range, spawns are anywhere farther away")
    {
        const SpawnList list = sample(judge, options_with({.near = {{"shelf*", 3, infinite}}}));
        REQUIRE(list.spawns.size() == 300);
        for (const Spawn& spawn : list.spawns) CHECK(shelf_distance(spawn) >= 3 - 1e-6);
    }
    SECTION("one of several headings")
    {
        // Only robots along the shelf fit between these two distances of their centre from its long side.
        SampleOptions options = options_with({.near = {{"shelf*", 0.2, 0.3}}}, 200);
        options.heading = HeadingRule{.kind = HeadingRule::Kind::Any, .count = 8};
        const SpawnList list = sample(judge, options);
        REQUIRE(list.spawns.size() == 200);
        std::set<double> yaws;
        for (const Spawn& spawn : list.spawns) {
            CHECK(shelf_distance(spawn) >= 0.2 - 1e-6);
            CHECK(shelf_distance(spawn) <= 0.3 + 1e-6);
            yaws.insert(spawn.yaw);
        }
        CHECK(yaws.size() == 8);
    }
}

TEST_CASE("spawns with a clearance have that free room")
{
    const Judge judge(shelf_map(), box_robot());
    SampleOptions options = options_with({.clearance = 0.7, .near = {{"shelf*", 0, 0.72}}});
    options.random_yaw = true;
    const SpawnList list = sample(judge, options);
    REQUIRE(list.spawns.size() == 300);
    for (const Spawn& spawn : list.spawns) CHECK(shelf_distance(spawn) >= 0.7 - 1e-6);
}

TEST_CASE("spawns face the nearest point of the parts")
{
    const Judge judge(shelf_map(), box_robot());
    const Stance stance = GENERATE(Stance::Level, Stance::Settled);
    SampleOptions options = options_with({.facing = "shelf_?"});
    options.stance = stance;
    const SpawnList list = sample(judge, options);
    REQUIRE(list.spawns.size() == 300);
    for (const Spawn& spawn : list.spawns) {
        const Point here = spawn.position.head<2>(), way = here.cwiseMax(shelf_low).cwiseMin(shelf_high) - here;
        CHECK(std::abs(std::remainder(spawn.yaw - std::atan2(way.y(), way.x()), 2 * std::numbers::pi)) < 1e-6);
    }
}

TEST_CASE("spawns stand on some parts or materials, or not on some")
{
    Scene scene;
    if (GENERATE(false, true)) {
        scene.parts.push_back({.name = "ground", .kind = "mesh", .label = Label::Terrain});
        append_mesh(scene, 0, road_and_sidewalk(), {});
    } else {
        add_shape(scene, "road", Label::Terrain, box_shape({6, 4, 0.2}, {{-3, 0, -0.1}}));
        add_shape(scene, "sidewalk", Label::Terrain, box_shape({6, 4, 0.2}, {{3, 0, -0.1}}));
    }
    const Judge judge(map_of(std::move(scene)), box_robot());
    const auto least_x = [&](const PlaceRules& rules, Stance stance) {
        SampleOptions options = options_with(rules, 1000);
        options.random_yaw = true;
        options.stance = stance;
        const SpawnList list = sample(judge, options);
        REQUIRE(list.spawns.size() == 1000);
        double out = infinite;
        for (const Spawn& spawn : list.spawns) {
            if (stance == Stance::Level) out = std::min(out, spawn.position.x());
            if (stance == Stance::Settled)
                for (const Point& corner : footprint(spawn)) out = std::min(out, corner.x());
        }
        return out;
    };
    for (const Stance stance : {Stance::Level, Stance::Settled})
        for (const PlaceRules& rules : {PlaceRules{.on = {"side*"}}, PlaceRules{.not_on = {"road"}}}) {
            const double least = least_x(rules, stance);
            CHECK(least >= -1e-6);
            CHECK(least < 0.05);
        }
    CHECK(least_x({.on = {"side*", "road"}}, Stance::Settled) < -5);
}

TEST_CASE("nodes and materials of a mesh file can be selected, also in a changed map, and info lists them")
{
    const Arena arena;
    arena.write("town.mtl", "newmtl road\nnewmtl sidewalk\nnewmtl oak\n");
    arena.write("town.obj",
                "mtllib town.mtl\no ground\nv -6 -2 0\nv 0 -2 0\nv 6 -2 0\nv -6 2 0\nv 0 2 0\nv 6 2 0\n"
                "usemtl road\nf 1 2 5 4\nusemtl sidewalk\nf 2 3 6 5\n"
                "o tree_1\nv 3 0 0\nv 3 0.1 0\nv 3 0 2\nusemtl oak\nf 7 8 9\n");
    arena.write("scene.yaml",
                "format: spawnfield-scene/1\nname: town\nparts:\n- {name: plate, label: obstacle, "
                "box: [1, 1, 0.1], xyz: [0, 0, -2]}\n- {name: town, label: terrain, mesh: "
                "town.obj, up: z, labels: [{node: 'tree*', label: obstacle}]}\n");
    REQUIRE(arena("bake scene.yaml -o town").status == 0);
    const ProgramRun info = arena("info town");
    CHECK_THAT(info.out, Contains("names in meshes, for rules of place such as --on\n") &&
                             Contains("node \"ground\", material \"road\": 2 triangles, z 0 to 0 m, terrain\n"));
    const auto spawns = [&](const std::string& rules) {
        const ProgramRun run = arena("sample town --robot box:0.4,0.4,0.2 -n 200 --yaw random" + rules);
        CHECK(run.status == 0);
        std::vector<Point> out;
        std::istringstream text(run.out);
        std::string line;
        for (std::getline(text, line); std::getline(text, line);) {
            Point& point = out.emplace_back();
            CHECK(std::sscanf(line.c_str(), "%lf,%lf", &point.x(), &point.y()) == 2);
        }
        CHECK(out.size() == 200);
        return out;
    };
    for (const Point& at : spawns(" --on SIDE*")) CHECK(at.x() > 0.2 - 1e-6);
    for (const Point& at : spawns(" --not-on sidewalk")) CHECK(at.x() < -0.2 + 1e-6);
    for (const Point& at : spawns(" --near 'tree_?' 0.5:0.6")) CHECK(std::abs((at - Point(3, 0)).norm() - 0.85) < 0.16);
    for (const Point& at : spawns(" --on oa? --on road --on 'side*' --near oak :1")) CHECK(at.x() > 1);
    // In a map with another mesh and without the first part, the numbers of the face groups are still right.
    arena.write("more.yaml",
                "format: spawnfield-scene/1\nname: more\nparts:\n- {name: west, label: ignore, mesh: "
                "town.obj, up: z, xyz: [-6, 0, 0], labels: [{node: 'tree*', label: obstacle}]}\n");
    for (const Point& at : spawns(" --with more.yaml --without plate --on sidewalk")) CHECK(at.x() > 0.2 - 1e-6);
    bool is_west = false;
    for (const Point& at : spawns(" --with more.yaml --near tree_1 0:0.6")) is_west |= at.x() < -2;
    CHECK(is_west);
    const ProgramRun none = arena("sample town --robot box:0.4,0.4,0.2 -n 1 --on lawn");
    CHECK(none.status == 2);
    CHECK_THAT(none.err, Contains("--on \"lawn\" matches no part of the map, and no node or material of its meshes; "
                                  "there are the parts plate, town and the names ground, road, sidewalk, tree_1, oak"));
}

TEST_CASE("spawns keep a distance from a point, are in its view, or hidden from it")
{
    const Judge judge(shelf_map(), box_robot());
    // A point in front of the middle of the shelf's long side, higher than the robot's top and lower than the shelf.
    const Vec3 point(1, -2, 0.6);
    const auto is_behind = [&](const Spawn& spawn) {  // the lines through the ends of the shelf's front side
        const Point way = spawn.position.head<2>() - point.head<2>();
        return way.y() > 0 && std::abs(way.x()) < way.y() / (shelf_low.y() - point.y());
    };
    SampleOptions in_view = options_with({.in_view_of = {point}}, 2000),
                  out_of_view = options_with({.hidden_from = {point}}, 2000);
    in_view.measures.sensor_height = out_of_view.measures.sensor_height = 0.5;
    const SpawnList seen = sample(judge, in_view), hidden = sample(judge, out_of_view);
    REQUIRE(seen.spawns.size() == 2000);
    REQUIRE(hidden.spawns.size() == 2000);
    for (const Spawn& spawn : hidden.spawns) CHECK((is_behind(spawn) && spawn.position.y() > shelf_high.y()));
    for (const Spawn& spawn : seen.spawns) CHECK_FALSE((is_behind(spawn) && spawn.position.y() > shelf_high.y()));
    CHECK(std::any_of(seen.spawns.begin(), seen.spawns.end(), [](const Spawn& s) { return s.position.y() > 1.2; }));

    // A robot whose sensor is above the shelf is visible everywhere: nothing is proven, but no spawn is found.
    out_of_view.place.hidden_from = {{1, -2, 2}};
    out_of_view.measures.sensor_height = 1.8;
    CHECK(sample(judge, out_of_view).spawns.empty());

    const SpawnList ring = sample(judge, options_with({.distance_to = {{-2, -1, 1, 1.1}, {-2, 0, 0, 1}}}));
    REQUIRE(ring.spawns.size() == 300);
    for (const Spawn& spawn : ring.spawns) {
        const double first = (spawn.position.head<2>() - Point(-2, -1)).norm();
        CHECK((first >= 1 && first <= 1.1 && (spawn.position.head<2>() - Point(-2, 0)).norm() <= 1));
    }
    CHECK(ring.draws < 5 * ring.spawns.size());

    const SpawnList nothing = sample(judge, options_with({.distance_to = {{0, 0, 50, 60}}}));
    CHECK((nothing.spawns.empty() && nothing.draws == 0 && nothing.is_full));
}

TEST_CASE("rules of place give the same bytes with 1, 2 and 8 threads")
{
    const Judge judge(training_map(), husky());
    SampleOptions options{.count = 400, .min_distance = 0.1, .seed = 9};
    options.place = {.clearance = 0.1,
                     .not_on = {"ramp"},
                     .near = {{"cube*", 0, 4}},
                     .distance_to = {{0, 0, 1, 12}},
                     .hidden_from = {{-2, 7, 3}},
                     .facing = "*ball"};
    std::set<std::string> texts;
    for (const int threads : {1, 2, 8}) {
        options.threads = threads;
        texts.insert(spawns_csv(sample(judge, options)));
    }
    CHECK(texts.size() == 1);
    CHECK(std::count(texts.begin()->begin(), texts.begin()->end(), '\n') == 401);
    options.seed = 10;
    CHECK(texts.count(spawns_csv(sample(judge, options))) == 0);
}

TEST_CASE("wrong rules of place are refused")
{
    const Judge judge(shelf_map(), box_robot());
    const auto with = [&](const PlaceRules& rules) { return sample(judge, options_with(rules)); };
    CHECK_THROWS_WITH(with({.clearance = 11}), "place rules: clearance is 11, needs 0 .. 10 m");
    CHECK_THROWS_WITH(with({.near = {{"rack*", 0, 1}}}),
                      Contains("near \"rack*\" matches no part of the map; there are floor, hall::shelf_1::board"));
    CHECK_THROWS_WITH(with({.near = {{"shelf*", 2, 1}}}), Contains("needs 0 <= low <= high"));
    CHECK_THROWS_WITH(with({.distance_to = {{0, NAN, 0, 1}}}), Contains("distance_to has a point that is not finite"));
    SampleOptions options = options_with({.facing = "shelf*"});
    options.random_yaw = true;
    CHECK_THROWS_WITH(sample(judge, options), Contains("also choose the yaw"));

    const Arena arena;
    const auto complaint = [&](const std::string& more) {
        const ProgramRun run = arena("sample map -n 5 -o out.csv" + husky_option + more);
        CHECK(run.status == 2);
        CHECK(arena.names().count("out.csv") == 0);
        return run.err;
    };
    CHECK_THAT(complaint("--near 'shelf*' 0:1"),
               Contains("--near \"shelf*\" matches no part of the map; there are floor"));
    CHECK_THAT(complaint("--near 'cube*' 1"), Contains("needs LOW:HIGH in m with 0 <= LOW <= HIGH"));
    CHECK_THAT(complaint("--near 'cube*' 2:1"), Contains("has the range \"2:1\""));
    CHECK_THAT(complaint("--facing 'cube*' --yaw 1"), Contains("--facing and --yaw both choose the yaw"));
    CHECK_THAT(complaint("--in-view-of 1,2"), Contains("needs x,y,z in m"));
    CHECK_THAT(complaint("--clearance 20"), Contains("--clearance is 20, needs 0 .. 10 m"));
    CHECK_THAT(complaint("--sensor-height 1"), Contains("only for --in-view-of, --hidden-from and view"));
    const ProgramRun run = arena("sample map -n 5" + husky_option +
                                 "--format json --near 'cube*' 0.5:1 --facing 'cube*'");
    CHECK(run.status == 0);
    CHECK_THAT(run.out, Contains("\"place\": \"near cube* 0.5:1 m, facing cube*\""));
    CHECK_THAT(run.out, Contains("\"yaw\": \"facing cube*\""));
}
