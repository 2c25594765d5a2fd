#include "catch.h"
#include "compare.h"
#include "program.h"
#include "query/area_index.h"
#include "query/draw.h"
#include "scene/nav2_map.h"
#include "test_map.h"
#include "worlds/hand_scene.h"

#include <spawnfield/error.h>
#include <spawnfield/poses.h>
#include <spawnfield/region_file.h>

#include <cmath>
#include <numbers>

using namespace spawnfield;
using Vec2 = Eigen::Vector2d;
using Ring = Region::Ring;

namespace {

constexpr double pi = std::numbers::pi;

Ring star(Draw& draw, const Vec2& centre, double radius, int corners)
{
    Ring out;
    for (int i = 0; i < corners; ++i) {
        const double turn = 2 * pi * i / corners, r = radius * (0.3 + 0.7 * draw.unit());
        out.push_back(centre + r * Vec2(std::cos(turn), std::sin(turn)));
    }
    return out;
}

/// Returns a ring with random corners, which crosses itself.
Ring tangle(Draw& draw, int corners)
{
    Ring out;
    for (int i = 0; i < corners; ++i) out.push_back({draw.uniform(-5, 5), draw.uniform(-5, 5)});
    return out;
}

std::vector<Region> random_regions(Draw& draw)
{
    std::vector<Region> out;
    const int regions = 1 + int(draw.unit() * 2);
    for (int r = 0; r < regions; ++r) {
        Region region;
        const int polygons = 1 + int(draw.unit() * 3);
        for (int p = 0; p < polygons; ++p) {
            const Vec2 centre{draw.uniform(-4, 4), draw.uniform(-4, 4)};
            if (draw.unit() < 0.3)
                region.polygons.push_back({tangle(draw, 3 + int(draw.unit() * 8))});
            else
                region.polygons.push_back({star(draw, centre, 3, 3 + int(draw.unit() * 30)),
                                           star(draw, centre, 0.8, 3 + int(draw.unit() * 6))});
        }
        out.push_back(region);
    }
    return out;
}

/// Returns whether p is in a region, by the even-odd rule with a ray upwards (the index uses sideways rays); nothing
/// near an edge.
std::optional<bool> slow_contains(const std::vector<Region>& regions, const Vec2& p)
{
    bool in_any = false;
    for (const Region& region : regions)
        for (const Region::Polygon& polygon : region.polygons) {
            bool inside = false;
            for (const Ring& ring : polygon)
                for (std::size_t i = 0; i < ring.size(); ++i) {
                    const Vec2 &a = ring[i], &b = ring[(i + 1) % ring.size()];
                    const double t = std::clamp((p - a).dot(b - a) / (b - a).squaredNorm(), 0.0, 1.0);
                    if ((a + t * (b - a) - p).norm() < 1e-6) return std::nullopt;
                    if ((a.x() < p.x()) != (b.x() < p.x()) &&
                        a.y() + (p.x() - a.x()) / (b.x() - a.x()) * (b.y() - a.y()) > p.y())
                        inside = !inside;
                }
            in_any = in_any || inside;
        }
    return in_any;
}

TestMap floor_map(double side)
{
    Scene scene;
    hand::add_mesh(scene, Label::Terrain, hand::rectangle(side, side));
    return map_of(scene);
}

SampleOptions options_in(const Area& area, std::size_t count, double min_distance = 0)
{
    return {
        .count = count, .min_distance = min_distance, .seed = 4, .stance = Stance::Level, .offset = 0.1, .area = area};
}

Region region_of(const std::vector<Region::Polygon>& polygons)
{
    Region out;
    out.polygons = polygons;
    return out;
}

const Region triangle = region_of({{{{-3, -3}, {4, -2}, {0, 4}}}});

}  // namespace

TEST_CASE("a point is in a region by the even-odd rule, counted in another way")
{
    std::size_t in = 0, out = 0;
    for (int round = 0; round < 150; ++round) {
        Draw draw(21, std::uint64_t(round));
        const std::vector<Region> regions = random_regions(draw);
        const PolygonIndex index(regions);
        for (int i = 0; i < 300; ++i) {
            const Vec2 p{draw.uniform(-8, 8), draw.uniform(-8, 8)};
            const auto wanted = slow_contains(regions, p);
            if (!wanted) continue;
            REQUIRE(index.contains(p) == *wanted);
            ++(*wanted ? in : out);
        }
        for (const Region& region : regions)  // edges belong to the region
            for (const Region::Polygon& polygon : region.polygons)
                for (const Ring& ring : polygon)
                    for (std::size_t k = 0; k < ring.size(); ++k) {
                        const Vec2 &a = ring[k], &b = ring[(k + 1) % ring.size()];
                        REQUIRE(index.contains(a));
                        REQUIRE(index.contains(a + draw.unit() * (b - a)));
                    }
    }
    CHECK(in > 4000);
    CHECK(out > 5000);
}

TEST_CASE("rectangles outside or completely inside a region are recognised")
{
    std::size_t missed = 0, covered = 0, clear = 0;
    for (int round = 0; round < 150; ++round) {
        Draw draw(22, std::uint64_t(round));
        const std::vector<Region> regions = random_regions(draw);
        const PolygonIndex index(regions);
        for (int i = 0; i < 60; ++i) {
            const double size = std::pow(10, draw.uniform(-4, 0.7));
            const double x = draw.uniform(-8, 8), y = draw.uniform(-8, 8);
            const Rect rect{x, y, x + size * draw.unit(), y + size};
            const bool misses = index.misses(rect), covers = index.covers(rect);
            CHECK_FALSE((misses && covers));
            missed += misses;
            covered += covers;
            bool all = true, any = false;
            for (int k = 0; k < 40; ++k) {
                const bool in = index.contains(
                    {draw.uniform(rect.low_x, rect.high_x), draw.uniform(rect.low_y, rect.high_y)});
                all = all && in;
                any = any || in;
            }
            if (misses) REQUIRE_FALSE(any);
            if (covers) REQUIRE(all);
            clear += !any;
        }
    }
    CHECK(double(missed) > 0.9 * double(clear));
    CHECK(covered > 500);
}

TEST_CASE("a comb of long teeth and a million corners take little memory and time")
{
    Ring comb;
    for (int i = 0; i < 50000; ++i) {
        comb.emplace_back(0.1 * i, 0);
        comb.emplace_back(0.1 * i, 1000);
        comb.emplace_back(0.1 * i + 0.05, 1000);
        comb.emplace_back(0.1 * i + 0.05, 0);
    }
    comb.emplace_back(5000, -1);
    comb.emplace_back(0, -1);
    const PolygonIndex index({region_of({{comb}})});
    CHECK(index.contains({0.02, 500}));
    CHECK_FALSE(index.contains({0.07, 500}));
    CHECK(index.contains({0.07, -0.5}));
}

TEST_CASE("regions are united, keep-outs are removed, and edges belong to both")
{
    Area area;
    area.within = {box_region(0, 0, 2, 2), box_region(1, 1, 3, 3)};
    area.keep_out = {box_region(1.5, 1.5, 4, 4)};
    const AreaIndex index(area);
    CHECK(index.contains({0, 0}));
    CHECK(index.contains({2, 1}));
    CHECK(index.contains({2.5, 1.2}));
    CHECK_FALSE(index.contains({1.5, 1.7}));
    CHECK_FALSE(index.contains({1.5, 1.5}));
    CHECK_FALSE(index.contains({0.5, 2.5}));
    CHECK(index.misses({2.1, 2.1, 2.9, 2.9}));
    CHECK(index.misses({4, 0, 5, 5}));
    CHECK_FALSE(index.misses({0.5, 0.5, 1, 1}));
    CHECK(area.bounds().max.head<2>() == Vec2(3, 3));
    CHECK(AreaIndex({}).contains({1e9, 0}));
    CHECK_FALSE(AreaIndex({}).misses({0, 0, 1, 1}));
}

TEST_CASE("samples are uniform by area over the region, and nowhere else")
{
    const TestMap map = floor_map(10);
    const Judge judge(map, load_robot("box:0.001,0.001,0.001@0,0,0"));
    Area area;
    area.within = {triangle};
    area.keep_out = {box_region(-0.5, -1, 0.5, 0)};
    const SpawnList list = sample(judge, options_in(area, 20000));
    REQUIRE(list.spawns.size() == 20000);
    CHECK(list.off_area > 0);
    const AreaIndex index(area);
    // Cells of 0.5 m with their shares of the area, counted with fine points.
    std::vector<double> observed(400, 0), share(400, 0);
    const auto bin = [](double x, double y) { return std::size_t((y + 5) / 0.5) * 20 + std::size_t((x + 5) / 0.5); };
    double total = 0;
    for (int i = 0; i < 4000; ++i)
        for (int j = 0; j < 4000; ++j) {
            const double x = -5 + (i + 0.5) / 400, y = -5 + (j + 0.5) / 400;
            if (!index.contains({x, y})) continue;
            share[bin(x, y)] += 1;
            total += 1;
        }
    for (const Spawn& spawn : list.spawns) {
        REQUIRE(index.contains(spawn.position.head<2>()));
        observed[bin(spawn.position.x(), spawn.position.y())] += 1;
    }
    double chi_square = 0, rest_observed = 0, rest_expected = 0;
    int bins = 0;
    for (std::size_t k = 0; k < share.size(); ++k) {
        const double expected = 20000 * share[k] / total;
        if (expected < 10) {
            rest_observed += observed[k];
            rest_expected += expected;
            continue;
        }
        chi_square += (observed[k] - expected) * (observed[k] - expected) / expected;
        ++bins;
    }
    chi_square += (rest_observed - rest_expected) * (rest_observed - rest_expected) / rest_expected;
    CAPTURE(chi_square, bins);
    CHECK(std::abs(chi_square - bins) <
          3.3 * std::sqrt(2.0 * bins));  // `bins` degrees of freedom; 0.1 % of correct runs are outside
}

TEST_CASE("a full region is proven full, with the same bytes with any number of threads")
{
    const TestMap map = training_map();
    const Judge judge(map, husky()), exhaustive = without_mask(judge);
    Area area;
    area.within = {triangle, region_of({{{{5, 5}, {9, 5}, {9, 9}, {5, 9}}, {{6, 6}, {8, 6}, {8, 8}, {6, 8}}}})};
    area.keep_out = {region_of({{{{-2, -2}, {0, -1}, {-1, 1}}}})};
    SampleOptions options = options_in(area, 10000, 1.0);
    options.threads = 1;
    const SpawnList one = sample(judge, options);
    CHECK(one.is_full);
    CHECK(one.undecided_area == 0);
    CHECK(one.spawns.size() > 10);
    for (const int threads : {2, 8}) {
        options.threads = threads;
        const SpawnList many = sample(judge, options);
        CHECK(spawns_csv(many) == spawns_csv(one));
        CHECK((many.draws == one.draws && many.off_area == one.off_area && many.counts == one.counts));
    }
    // Dense probing shows that nothing can be added.
    const AreaIndex index(area);
    std::size_t probes = 0;
    for (double y = -3; y <= 9; y += 0.05)
        for (double x = -3; x <= 9; x += 0.05) {
            if (!index.contains({x, y})) continue;
            const Column column = column_at(map.geometry, x, y);
            for (const double layer : column.layers) {
                const Vec3 p(x, y, layer + *options.offset);
                ++probes;
                const bool far = std::none_of(one.spawns.begin(), one.spawns.end(),
                                              [&](const Spawn& spawn) { return (spawn.position - p).norm() < 1.0; });
                if (far) CHECK_FALSE(exhaustive.is_valid({p, Mat3::Identity()}));
            }
        }
    CHECK(probes > 5000);
}

TEST_CASE("a sliver of a ten-thousandth of the map is sampled, too, and an empty region is proven empty")
{
    const TestMap map = floor_map(200);
    const Judge judge(map, load_robot("box:0.3,0.2,0.2"));
    Area area;
    area.within = {region_of({{{{-90, -90}, {90, 89.98}, {90, 90.01}}}})};  // 2.7 m2 of a box of 32,400
    const SpawnList sliver = sample(judge, options_in(area, 400));
    CHECK(sliver.spawns.size() == 400);
    for (const Spawn& spawn : sliver.spawns) CHECK(AreaIndex(area).contains(spawn.position.head<2>()));
    area.within = {box_region(300, 300, 310, 310)};
    const SpawnList off_map = sample(judge, options_in(area, 5, 1));
    CHECK(off_map.spawns.empty());
    CHECK(off_map.is_full);
    area.within = {box_region(0, 0, 10, 10)};
    area.keep_out = {box_region(-1, -1, 11, 11)};
    const SpawnList nothing = sample(judge, options_in(area, 5, 1));
    CHECK(nothing.spawns.empty());
    CHECK(nothing.is_full);
}

TEST_CASE("a raster in a region has the columns of the whole raster that are in the region")
{
    const TestMap map = training_map();
    const Judge judge(map, husky());
    const int dims = GENERATE(2, 3);
    RasterOptions options{.dims = dims, .step = 0.5, .step_z = 1};
    const RasterResult whole = raster(judge, options);
    options.area.within = {triangle, box_region(5, 5, 9, 9)};
    options.area.keep_out = {box_region(6, 6, 7, 7)};
    const RasterResult part = raster(judge, options);
    const AreaIndex index(options.area);
    VerdictCounts counts;
    std::vector<RasterPose> wanted, got;
    for_each_pose(whole, true, [&](const RasterPose& pose) {
        if (!index.contains({pose.x, pose.y})) return;
        ++counts[pose.verdict];
        wanted.push_back(pose);
    });
    for_each_pose(part, true, [&](const RasterPose& pose) { got.push_back(pose); });
    CHECK(part.counts == counts);
    REQUIRE(got.size() == wanted.size());
    CHECK(got.size() > 150);
    bool same = true;
    for (std::size_t i = 0; i < got.size(); ++i)
        same = same && got[i].x == wanted[i].x && got[i].y == wanted[i].y && got[i].z == wanted[i].z &&
               got[i].verdict == wanted[i].verdict;
    CHECK(same);
}

TEST_CASE("a search in a region finds spawns only there, and ends")
{
    const TestMap map = training_map();
    const Judge judge(map, husky());
    SearchOptions options{.count = 20, .min_distance = 0.5, .max_failures = 20000};
    options.area.within = {triangle};
    const SpawnList list = search(judge, options);
    CHECK(list.spawns.size() == 20);
    CHECK(list.off_area > 0);
    for (const Spawn& spawn : list.spawns) CHECK(AreaIndex(options.area).contains(spawn.position.head<2>()));
    options.area.within = {box_region(100, 100, 101, 101)};
    const SpawnList none = search(judge, options);
    CHECK(none.spawns.empty());
    CHECK(none.off_area == 20000);
}

TEST_CASE("GeoJSON of every kind with areas is read")
{
    const TempFolder folder;
    const std::string outer = "[[0,0],[4,0],[4,4],[0,4],[0,0]]", hole = "[[1,1,9],[1,2,9],[2,2,9],[2,1,9],[1,1,9]]",
                      far = "[[10,0],[12,0],[11,3],[10,0]]";
    const std::string polygon = R"({"type":"Polygon","coordinates":[)" + outer + "," + hole + "]}";
    const auto read = [&](const std::string& text) { return read_region(folder.write("a.geojson", text)); };
    const auto check_hole = [&](const Region& region) {
        const PolygonIndex index({region});
        CHECK(index.contains({0.5, 0.5}));
        CHECK(index.contains({1, 1.5}));
        CHECK_FALSE(index.contains({1.5, 1.5}));
        CHECK_FALSE(index.contains({5, 1}));
    };
    check_hole(read(polygon));
    check_hole(read(R"({"type":"MultiPolygon","coordinates":[[)" + outer + "," + hole + "],[" + far + "]]}"));
    check_hole(read(R"({"type":"Feature","properties":{},"geometry":)" + polygon + "}"));
    check_hole(read(R"({"type":"GeometryCollection","geometries":[)" + polygon + "]}"));
    const Region all = read(
        R"({"type":"FeatureCollection","features":[{"type":"Feature","properties":null,"geometry":)" + polygon +
        R"(},{"type":"Feature","geometry":null},{"type":"Feature","geometry":{"type":"Point","coordinates":[1,1]}}]})");
    check_hole(all);
    CHECK(all.notices == std::vector<std::string>{(folder / "a.geojson").string() +
                                                  ": 1 point or line ignored: points and lines have no area"});
    CHECK(all.name == "a.geojson");
    const Region utm = read(
        R"({"type":"Polygon","crs":{"type":"name","properties":{"name":"EPSG:32611"}},"coordinates":[)" + outer + "]}");
    CHECK_THAT(utm.notices.at(0), Contains("crs EPSG:32611 is ignored"));
}

TEST_CASE("CSV polygons end at empty lines or where their name changes")
{
    const TempFolder folder;
    const auto read = [&](const std::string& text) { return read_region(folder.write("a.csv", text)); };
    const std::vector<Region::Polygon> two = {{{{0, 0}, {4, 0}, {4, 4}}}, {{{10, 0}, {12, 0}, {11, 3}}}};
    CHECK(read("0,0\n4,0\n4,4\n0,0\n\n\n10,0\n12,0\n11,3\n").polygons == two);
    CHECK(read("x,y\r\n0,0\r\n4,0\r\n4,4\r\n\r\n# more\r\n10, 0\r\n12 ,0\r\n11,3").polygons == two);
    CHECK(read("polygon,y,x,note\na,0,0,\na,0,4,\na,4,4,\nb,0,10,\nb,0,12,\nb,3,11,end\n").polygons == two);
    CHECK(read("x,y,z,polygon\n0,0,7,a\n4,0,7,a\n4,4,7,a\n").polygons.size() == 1);
}

TEST_CASE("CSV regions of spreadsheets, with a byte order mark and quotes, are read")
{
    const TempFolder folder;
    const Region region = read_region(folder.write(
        "a.csv", "\xEF\xBB\xBF\"x\",\"y\",\"note\"\r\n\"0\",\"0\",\"a, b\"\r\n\"2\",\"0\",\r\n\"2\",\"3\",\r\n"));
    REQUIRE(region.polygons.size() == 1);
    CHECK(region.polygons[0][0].size() == 3);
    CHECK(region.polygons[0][0][2] == Vec2(2, 3));
}

TEST_CASE("a nav2 map is the region of its free cells, or a keep-out of its occupied ones, at any yaw")
{
    const TempFolder folder;
    Draw draw(31, 0);
    constexpr int rows = 19, cols = 27;
    std::string pixels = "P2\n27 19\n255\n";
    for (int i = 0; i < rows * cols; ++i)
        pixels += std::to_string(std::array{0, 205, 254, 254}[std::size_t(draw.unit() * 4)]) + " ";
    folder.write("a.pgm", pixels);
    const std::string yaw = GENERATE("0", "0.7");
    const auto file = folder.write("map.yaml", "image: a.pgm\nresolution: 0.3\norigin: [2, -1, " + yaw +
                                                   "]\nnegate: 0\noccupied_thresh: 0.65\nfree_thresh: 0.196\n");
    const Nav2Map map = read_nav2_map(file);
    for (const MapCells cells : {MapCells::Free, MapCells::Occupied}) {
        const Region region = read_region(file, cells);
        CHECK(region.polygons.size() == 1);
        const PolygonIndex index({region});
        for (int row = 0; row < rows; ++row)
            for (int col = 0; col < cols; ++col) {
                const Vec2 low = map.corner(row + 1, col).head<2>(), high = map.corner(row, col + 1).head<2>(),
                           left = map.corner(row, col).head<2>();
                const bool wanted = map.cell(row, col) ==
                                    (cells == MapCells::Free ? Nav2Map::Cell::Free : Nav2Map::Cell::Occupied);
                REQUIRE(index.contains((low + high) / 2) == wanted);
                REQUIRE(index.contains(0.98 * left + 0.01 * (low + high)) == wanted);
            }
    }
}

TEST_CASE("invalid regions are refused with the place")
{
    const TempFolder folder;
    const auto check_refused = [&](const std::string& name, const std::string& text, const std::string& reason) {
        CHECK_THROWS_WITH(read_region(folder.write(name, text)), (folder / name).string() + ": " + reason);
    };
    const auto polygon = [](const std::string& ring) { return R"({"type":"Polygon","coordinates":[)" + ring + "]}"; };
    check_refused("a.json", polygon("[[0,0],[1,0],[1,1]]"),
                  "$.coordinates[0] is not closed: its last position differs from its first");
    check_refused("a.json", polygon("[[0,0],[1,0],[0,0]]"),
                  "$.coordinates[0] has 2 different corners, needs at least 3");
    check_refused("a.json", polygon("[[0,0],[1,1],[2,2],[0,0]]"),
                  "$.coordinates[0] has no area: its corners lie on one line");
    check_refused("a.json", polygon("[[0,0],[1,\"1\"],[2,2],[0,0]]"), "$.coordinates[0][1] is not a position [x, y]");
    check_refused("a.json", R"({"type":"Polygon"})", "$.coordinates is missing or is not a list");
    check_refused("a.json", R"({"type":"Polygon","coordinates":[]})", "$.coordinates is not a list of rings");
    check_refused(
        "a.json", R"({"type":"Topology"})",
        "$ has type \"Topology\", needs Polygon, MultiPolygon, Feature, FeatureCollection or GeometryCollection");
    check_refused("a.json", R"({"type":"FeatureCollection","features":[{"type":"Feature"}]})",
                  "$.features[0].geometry is missing");
    check_refused("a.json", R"({"type":"Point","coordinates":[1,1]})", "has no polygon, only 1 point or line");
    check_refused("a.json", "[]", "$ is not an object");
    std::string deep;
    for (int i = 0; i < 5000; ++i) deep += R"({"type":"GeometryCollection","geometries":[)";
    for (int i = 0; i < 5000; ++i) deep += "]}";
    CHECK_THROWS_WITH(read_region(folder.write("a.json", deep)), Contains("is nested too deep"));
    CHECK_THROWS_WITH(read_region(folder.write("a.json", "{\"type\":")), Contains("is not valid JSON"));
    CHECK_THROWS_WITH(read_region(folder.write("a.json", polygon("[[0,0],[NaN,0],[1,1],[0,0]]"))),
                      Contains("is not valid JSON"));
    CHECK_THROWS_WITH(read_region(folder.write("a.json", polygon("[[0,0],[1e999,0],[1,1],[0,0]]"))),
                      Contains("is not valid JSON"));
    check_refused(
        "a.json",
        R"({"type":"Polygon","crs":{"type":"name","properties":{"name":"urn:ogc:def:crs:OGC:1.3:CRS84"}},"coordinates":[]})",
        "has crs urn:ogc:def:crs:OGC:1.3:CRS84, which is in degrees; needs metres in the map's frame (ogr2ogr "
        "-t_srs converts it)");
    check_refused("a.csv", "0,0\n1,0\n\n", "line 1: the polygon has 2 different corners, needs at least 3");
    check_refused("a.csv", "0,0\n1,0\n2,0\n", "line 1: the polygon has no area: its corners lie on one line");
    check_refused("a.csv", "0,0\n1,x\n2,0\n", "line 2: \"x\" is not a finite number");
    check_refused("a.csv", "0,0\n1,nan\n2,0\n", "line 2: \"nan\" is not a finite number");
    check_refused("a.csv", "0,0,0\n", "line 1: has 3 fields, needs x,y (a header line names further ones)");
    check_refused("a.csv", "lon,lat\n", "line 1: has neither numbers x,y nor the names of such columns");
    check_refused("a.csv", "", "has no polygon: x,y of three corners or more are needed");
    check_refused("a.yaml", "format: spawnfield-scene/1\n",
                  "is not a 2D map of nav2 or ROS (keys image, resolution, origin, …)");
    CHECK_THROWS_WITH(read_region(folder / "none.json"),
                      (folder / "none.json").string() + ": does not exist; is the path right?");
    CHECK_THROWS_WITH(read_region(folder.path()), Contains("is a folder, needs a file"));
}

TEST_CASE("regions that are cut at any byte are read or refused")
{
    const TempFolder folder;
    folder.write("a.pgm", "P5\n3 2\n255\n\xfe\xfe\x01\xfe\xcd\x02");
    const std::string json =
        R"({"type":"FeatureCollection","features":[{"type":"Feature","geometry":{"type":"MultiPolygon","coordinates":[[[[0,0],[4,0],[4,4],[0,0]]]]}}]})";
    const std::string yaml =
        "image: a.pgm\nresolution: 0.3\norigin: [2, -1, 0.5]\nnegate: 0\noccupied_thresh: 0.65\nfree_thresh: 0.196\n";
    const auto [name, bytes] = GENERATE_COPY(
        std::pair<std::string, std::string>{"a.json", json},
        std::pair<std::string, std::string>{"a.csv", "x,y\n0,0\n4,0\n4,4\n\n7,7\n8,7\n8,8\n"},
        std::pair<std::string, std::string>{"a.yaml", yaml});
    std::size_t good = 0;
    for (std::size_t length = 0; length <= bytes.size(); ++length)
        for (const char wrong : {'\0', '\x15'}) {
            std::string changed = bytes.substr(0, wrong == 0 ? length : bytes.size());
            if (wrong != 0 && length < bytes.size()) changed[length] = char(changed[length] ^ wrong);
            try {
                good += !read_region(folder.write(name, changed)).polygons.empty();
            } catch (const FileError&) {
            }
        }
    CHECK(good >= 2);
}

TEST_CASE("the program accepts regions and keep-outs, and gives notices about unusual ones")
{
    const TempFolder folder;
    folder.write("scene.yaml", "format: spawnfield-scene/1\nparts: [{name: floor, label: terrain, plane: [20, 20]}]\n");
    REQUIRE(run_program(folder, "bake scene.yaml -o map --resolution 0.5").status == 0);
    folder.write("a.geojson", R"({"type":"Polygon","coordinates":[[[-3,-3],[4,-2],[0,4],[-3,-3]]]})");
    folder.write("out.csv", "-1,-1\n1,-1\n1,1\n-1,1\n");
    const std::string robot = " --robot box:0.2,0.2,0.2 ";
    const ProgramRun run = run_program(
        folder, "sample map" + robot + "-n 50 --region a.geojson --keep-out out.csv --format json -o s.json");
    CHECK(run.status == 0);
    CHECK_THAT(run.err, Contains(" off the region;"));
    const std::string json = bytes_of(folder / "s.json");
    CHECK_THAT(json, Contains("\"region\": [\n      \"a.geojson\"") && Contains("\"keep_out\": [\n      \"out.csv\""));
    // A single box gives the output of earlier versions.
    const ProgramRun box = run_program(folder, "sample map" + robot + "-n 5 --region -3,-3,4,4");
    CHECK(box.status == 0);
    CHECK(box.err.find("off the region") == std::string::npos);
    CHECK(run_program(folder, "sample map" + robot + "-n 5 --region 5,5,6,6 --region -3,-3,-2,-2").status == 0);
    CHECK(run_program(folder, "raster map" + robot + "--dims 2 --step 1 --region a.geojson -o r.csv --heatmap r.png")
              .status == 0);
    const std::string csv = bytes_of(folder / "r.csv");
    CHECK(std::count(csv.begin(), csv.end(), '\n') < 40);
    CHECK(run_program(folder, "heatmap map" + robot + "--region a.geojson -o h.png").status == 0);
    CHECK(run_program(folder,
                      "search map" + robot +
                          "-n 3 --min-distance 0.5 --max-failures 5000 --bounds -10,-10,0,10,10,0.5 --region a.geojson")
              .status == 0);
    CHECK(run_program(folder, "sample map" + robot + "-n 5 --region none.geojson").status == 4);
    CHECK(run_program(folder, "sample map" + robot + "-n 5 --region 1,2,3").status == 2);
    folder.write("degrees.csv", "7.001,46.5\n7.002,46.5\n7.002,46.501\n");
    const ProgramRun degrees = run_program(folder, "sample map" + robot + "-n 5 --region degrees.csv");
    CHECK(degrees.status == 3);
    CHECK_THAT(degrees.err, Contains("--region degrees.csv 7.001, 46.5 to 7.002, 46.501 m lies off the map") &&
                                Contains("convert them to metres"));
}
