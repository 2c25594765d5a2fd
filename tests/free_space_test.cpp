#include "catch.h"
#include "free_space/bounds_tile.h"
#include "free_space/footprint.h"
#include "free_space/mask.h"
#include "free_space/sixteen.h"
#include "query/draw.h"
#include "slow.h"
#include "test_map.h"
#include "worlds/hand_scene.h"

#include <spawnfield/collision.h>
#include <spawnfield/free_space.h>

#include <algorithm>
#include <cmath>
#include <numeric>

using namespace spawnfield;

namespace {

constexpr double pi = 3.14159265358979323846;

/// The cell of a level that contains (x, y): its tile and its index there.
struct CellAt {
    BoundsTile tile;
    std::uint32_t cell;
};

CellAt cell_at(const SolidBounds& bounds, std::size_t level, double x, double y)
{
    const auto number = [&](double offset) {
        return std::uint32_t(std::floor(offset / bounds.impl().levels()[level].cell));
    };
    const std::uint32_t col = number(x - bounds.impl().x0), row = number(y - bounds.impl().y0);
    return {bounds.impl().open(level, col / BoundsTile::side, row / BoundsTile::side),
            row % BoundsTile::side * BoundsTile::side + col % BoundsTile::side};
}

/// Returns whether z may be solid according to the bounds.
bool may_be_solid(const CellAt& at, double z)
{
    if (at.tile.is_empty() || z > at.tile.height(at.tile.tops[at.cell])) return false;
    if (!at.tile.bounds.has(at.cell)) return at.tile.tops[at.cell] > 0;
    for (const QuantizedSpan& span : at.tile.bounds.of(at.cell))
        if (z >= at.tile.height(span.bottom) && z <= at.tile.height(span.top)) return true;
    return false;
}

Scene floor_scene()
{
    Scene scene;
    hand::add_mesh(scene, Label::Terrain, hand::rectangle(10, 10));
    return scene;
}

Shape box_at(const Vec3& size, const Vec3& centre)
{
    Shape shape;
    shape.size = size;
    shape.pose.position = centre;
    return shape;
}

}  // namespace

TEST_CASE("the bounds of every level contain everything that is solid in their cells")
{
    std::size_t solid_points = 0;
    for (std::uint64_t seed = 1; seed <= 40; ++seed) {
        Random random(seed + 100);
        const TestMap map = map_of(random_scene(seed), random.between(0.05, 0.6));
        for (int i = 0; i < 400; ++i) {
            const double x = random.between(map.bounds.min.x(), map.bounds.max.x()),
                         y = random.between(map.bounds.min.y(), map.bounds.max.y());
            for (const slow::Span& span : slow::column(map.scene, x, y).spans)
                for (std::size_t level = 0; level < map.solid_bounds.impl().levels().size(); ++level) {
                    CAPTURE(seed, level, x, y, span.bottom, span.top);
                    const CellAt at = cell_at(map.solid_bounds, level, x, y);
                    CHECK(may_be_solid(at, span.top));
                    CHECK(may_be_solid(at, (span.bottom + span.top) / 2));
                    ++solid_points;
                }
        }
    }
    CHECK(solid_points > 50000);
}

TEST_CASE("the top of a cell is as high as a ball over it, at most one height step of the tile higher")
{
    Scene scene;
    Shape ball;
    ball.kind = ShapeKind::Sphere;
    ball.size[0] = 3;
    hand::add_shape(scene, Label::Terrain, ball);
    const TestMap map = map_of(scene, 0.1);
    for (double x = -2.95; x < 3; x += 0.1)
        for (double y = -2.95; y < 3; y += 0.1) {
            const double nx = std::max(0.0, std::abs(x) - 0.05), ny = std::max(0.0, std::abs(y) - 0.05),
                         rest = 9 - nx * nx - ny * ny;
            if (rest < 1e-3) continue;
            const CellAt at = cell_at(map.solid_bounds, 0, x, y);
            const double top = at.tile.height(at.tile.tops[at.cell]);
            CHECK(top >= std::sqrt(rest) - 1e-9);
            CHECK(top <= std::sqrt(rest) + 1e-6 + at.tile.slack);
        }
}

TEST_CASE("empty cells are marked as empty")
{
    const TestMap map = map_of(floor_scene(), 0.5, {Vec3(-10, -10, 0), Vec3(10, 10, 1)});
    for (double x = -9.75; x < 10; x += 0.5)
        for (double y = -9.75; y < 10; y += 0.5) {
            const bool near = std::abs(x) < 5.3 && std::abs(y) < 5.3;  // a cell that touches the edge counts, too
            CHECK(may_be_solid(cell_at(map.solid_bounds, 0, x, y), 0) == near);
        }
}

TEST_CASE("a robot above a floor is free, inside it blocked, and exactly on it a candidate")
{
    const TestMap map = map_of(floor_scene(), 0.05);
    const FreeSpace space(map.solid_bounds, load_robot("box:0.6,0.4,0.3"));
    for (const double yaw : {0.0, 0.3, 2.0}) {
        CHECK(space.proof_of({0.123, -0.4, 0.01}, yaw) == Proof::Free);
        CHECK(space.proof_of({0.123, -0.4, 5}, yaw) == Proof::Free);
        CHECK(space.proof_of({0.123, -0.4, -0.1}, yaw) == Proof::Blocked);
        CHECK(space.proof_of({0.123, -0.4, 0}, yaw) == Proof::Candidate);
        CHECK(space.proof_of({20, 0, 0}, yaw) == Proof::Free);  // the scene has nothing beyond the map
    }
    CHECK(space.proof_at_every_yaw({0.1, 0.1, 0.01}) == Proof::Free);
    CHECK(space.proof_at_every_yaw({0.1, 0.1, -0.1}) == Proof::Blocked);
    CHECK(space.proof_of(Pose{{0, 0, 0.4}, rotation_from_rpy(0.3, 0.2, 1)}) == Proof::Free);
    CHECK(space.proof_of(Pose{{0, 0, 0.05}, rotation_from_rpy(0.3, 0.2, 1)}) == Proof::Candidate);
}

TEST_CASE("each part of a robot counts by itself, and so does what hangs above it")
{
    Scene scene = floor_scene();
    hand::add_shape(scene, Label::Obstacle, box_at({2, 2, 0.2}, {0, 0, 1}));  // a roof from 0.9 to 1.1
    const TestMap map = map_of(scene, 0.05);
    const FreeSpace low(map.solid_bounds, load_robot("box:0.6,0.4,0.3"));
    CHECK(low.proof_of({0, 0, 0.1}, 0) == Proof::Free);
    CHECK(low.proof_of({0, 0, 0.7}, 0) == Proof::Blocked);  // its upper face is in the roof
    CHECK(low.proof_of({0, 0, 0.85}, 0) == Proof::Blocked);
    CHECK(low.proof_of({0, 0, 1.2}, 0) == Proof::Free);
    Robot masted = load_robot("box:0.6,0.4,0.3");
    masted.parts.push_back(load_robot("box:0.17,0.17,1.2@-0.2,0,0.6").parts[0]);
    const FreeSpace space(map.solid_bounds, masted);
    CHECK(space.proof_of({0, 0, 0.05}, 0) == Proof::Blocked);
    CHECK(space.proof_of({1.1, 0, 0.05}, 0) == Proof::Blocked);  // the mast reaches below the edge of the roof at x = 1
    CHECK(space.proof_of({1.4, 0, 0.05}, 0) == Proof::Free);     // body and mast are clear
    CHECK(space.proof_of({-1.15, 0, 0.05}, 0) == Proof::Free);   // the body is under the roof, the mast beside it
}

TEST_CASE("a map that is smaller than its scene proves nothing beyond its edge")
{
    Scene scene = floor_scene();
    hand::add_shape(scene, Label::Obstacle, box_at({1, 1, 1}, {3, 0, 0.5}));
    const TestMap map = map_of(scene, 0.1, {Vec3(-2, -2, -1), Vec3(2.3, 2, 2)});
    const FreeSpace space(map.solid_bounds, load_robot("box:0.6,0.4,0.3"));
    CHECK(space.proof_of({1.5, 0, 0.1}, 0) == Proof::Free);
    CHECK(space.proof_of({2.25, 0, 0.1}, 0) == Proof::Candidate);
    CHECK(space.proof_of({8, 0, 0.1}, 0) == Proof::Candidate);
}

TEST_CASE("the proofs of a row are true, and the same as those of its poses one by one")
{
    std::array<std::size_t, 3> proofs{};
    for (std::uint64_t seed = 1; seed <= 24; ++seed) {
        Draw draw(seed, 0);
        const TestMap map = map_of(random_scene(seed), draw.uniform(0.02, 0.3));
        Robot robot = load_robot("box:0.6,0.4,0.3");
        if (seed % 3 == 0) robot.parts.push_back(load_robot("box:0.17,3,1.2@-0.2,0,0.6").parts[0]);
        const double yaw = seed % 2 == 0 ? 0 : draw.uniform(-pi, pi);  // at yaw 0, footprints are along the axes
        const FreeSpace space(map.solid_bounds, robot);
        const CollisionChecker checker(map.geometry, robot);
        Mask mask(space.impl(), yaw), other(space.impl(), yaw);
        if (seed % 4 < 2) {
            mask.leave_layered_cells();
            other.leave_layered_cells();
        }
        std::vector<double> x(150), z(x.size());
        for (int row = 0; row < 20; ++row) {
            const double y = draw.uniform(map.bounds.min.y() - 1, map.bounds.max.y() + 1);
            if (row % 2 == 0)  // else the x of the last row, as in a raster
                for (double& at : x) at = draw.uniform(map.bounds.min.x() - 1, map.bounds.max.x() + 1);
            for (double& at : z) at = draw.uniform(map.bounds.min.z(), map.bounds.max.z() + 0.5);
            std::sort(x.begin(), x.end());
            z[7] = std::numeric_limits<double>::quiet_NaN();
            std::vector<Proof> found(x.size());
            mask.prove(x, y, z, found);
            CHECK(found[7] != Proof::Blocked);
            for (std::size_t i = 0; i < x.size(); ++i) {
                if (std::isnan(z[i])) continue;
                const Vec3 position(x[i], y, z[i]);
                CAPTURE(seed, yaw, position.transpose());
                REQUIRE(found[i] == other.proof_of(position));
                if (found[i] != Proof::Candidate)
                    REQUIRE((found[i] == Proof::Free) == checker.is_free({position, rotation_from_rpy(0, 0, yaw)}));
                ++proofs[std::size_t(found[i])];
            }
            std::vector<double> far = x;
            far.back() = 1e300;
            mask.prove(far, y, z, found);
            CHECK(std::count(found.begin(), found.end(), Proof::Candidate) == std::ptrdiff_t(found.size()));
        }
    }
    for (const std::size_t count : proofs) CHECK(count > 1000);
}

TEST_CASE("sixteen values are raised and compared like numbers one by one")
{
    for (std::uint64_t seed = 1; seed <= 2000; ++seed) {
        Draw draw(seed, 0);
        const auto value = [&] {  // often the lowest or the highest one
            return std::uint16_t(std::clamp(draw.uniform(-8192, 65536 + 8192), 0.0, 65535.0));
        };
        std::array<std::uint16_t, Sixteen::width> a, b, highest;
        for (std::size_t k = 0; k < a.size(); ++k) {
            a[k] = value();
            b[k] = value();
        }
        Sixteen values;
        values.raise(Sixteen::read(a.data()));
        values.raise(Sixteen::read(b.data()));
        values.write(highest.data());
        const std::uint32_t low = seed % 3 == 0 ? a[0] : value(), high = std::uint32_t{value()} + seed % 2;
        std::uint64_t within = 0;
        for (std::size_t k = 0; k < a.size(); ++k) {
            REQUIRE(highest[k] == std::max(a[k], b[k]));
            within |= std::uint64_t{highest[k] >= low && highest[k] <= high} << k;
        }
        CAPTURE(seed, low, high);
        REQUIRE(values.bits_within(low, high) == within);
        REQUIRE(values.bits_within(65536, 65535) == 0);
    }
}

TEST_CASE("the highest values of windows of columns are those of a plain search")
{
    constexpr int side = BoundsTile::side;
    RowMaxima maxima;
    for (int i = 0; i < 3 * RowMaxima::widest; ++i) {
        const int wide = 1 + 40 * i % RowMaxima::widest;  // wide and narrow windows in turns
        Draw draw(std::uint64_t(i), 0);
        RowMaxima::Values values;
        for (std::uint16_t& value : values) value = i % 7 == 0 ? 0 : std::uint16_t(draw.uniform(0, 65536));
        if (i % 7 == 0)
            maxima.set_zero(wide);
        else
            maxima.set(values, wide);
        for (int first = -wide; first < side; ++first)
            for (int last = first + wide - 1; last <= first + wide; ++last) {
                if (last < 0) continue;
                const auto highest = std::max_element(values.begin() + std::max(first, 0),
                                                      values.begin() + std::min(last + 1, side));
                CAPTURE(wide, first, last);
                REQUIRE(maxima.highest(RowMaxima::columns(first, last, wide)) == *highest);
            }
        REQUIRE(maxima.highest(RowMaxima::Columns()) == 0);
    }
}

TEST_CASE("the columns of a row of poses are those of each pose, in every tile that it meets")
{
    constexpr int side = BoundsTile::side;
    std::size_t cores = 0, unknown = 0, far = 0;
    RowColumns found;
    for (std::uint64_t seed = 1; seed <= 400; ++seed) {
        Draw draw(seed, 0);
        const RowColumns::Raster raster{draw.uniform(-5, 5), draw.uniform(0.05, 0.5), int(draw.uniform(1, 700))};
        const double left = draw.uniform(-3, 0), right = left + draw.uniform(0, 5), rim = draw.uniform(0, 0.6),
                     end = raster.x0 + raster.known_cols * raster.cell;
        std::optional<Rect> core;
        if (seed % 5 != 0) core = Rect{left + rim, 0, right - rim, 0};
        std::vector<double> x(std::size_t(draw.uniform(1, 150)));
        for (double& at : x) at = draw.uniform(raster.x0 - 6, end + 6);
        std::sort(x.begin(), x.end());
        found.set(x, {{left, 0, right, 0}, core}, raster);
        REQUIRE(found.fit_windows() == (int(std::floor((right - left) / raster.cell)) + 1 <= RowMaxima::widest));
        if (!found.fit_windows()) continue;
        for (std::size_t i = 0; i < x.size(); ++i) {
            const auto cell = [&](double offset) { return (x[i] - raster.x0 + offset) * (1 / raster.cell); };
            const int first = int(std::floor(cell(left))), last = int(std::floor(cell(right)));
            CAPTURE(seed, i, first, last);
            if (std::find(found.unknown().begin(), found.unknown().end(), i) != found.unknown().end()) {
                REQUIRE((first < 0 || last >= raster.known_cols));  // a number of columns fits no window very rarely
                ++unknown;
                continue;
            }
            REQUIRE((first >= 0 && last < raster.known_cols));
            std::uint64_t tiles = 0;
            for (const RowColumns::InTile& tile : found.tiles()) {
                if (i < tile.first_pose || i >= tile.first_pose + tile.count) continue;
                tiles += tile.col;
                const RowColumns::Seen& seen = found.seen_in(tile)[i - tile.first_pose];
                // The value of a column is its number, so that the highest one is the last one in the tile.
                RowMaxima::Values values;
                std::iota(values.begin(), values.end(), std::uint16_t{1});
                RowMaxima maxima;
                maxima.set(values, found.wide());
                const int tile_left = int(tile.col) * side, seen_last = std::min(last - tile_left, side - 1);
                REQUIRE(maxima.highest(seen.all) == seen_last + 1);
                for (int col = 0; col < side; ++col)
                    REQUIRE((seen.bits >> col & 1) == (col + tile_left >= first && col + tile_left <= last));
                const int core_first = core ? int(std::ceil(cell(core->low_x))) : 1,
                          core_last = core ? int(std::floor(cell(core->high_x))) - 1 : 0;
                const bool has_core = core_first <= core_last && core_first < tile_left + side &&
                                      core_last >= tile_left;
                maxima.set(values, found.core_wide());
                REQUIRE(maxima.highest(seen.core) == (has_core ? std::min(core_last - tile_left, side - 1) + 1 : 0));
                cores += has_core;
            }
            std::uint64_t expected = 0;
            for (int col = first / side; col <= last / side; ++col) expected += std::uint64_t(col);
            REQUIRE(tiles == expected);
            far += last / side - first / side;
        }
    }
    CHECK(cores > 5000);
    CHECK(unknown > 1000);
    CHECK(far > 1000);
}

TEST_CASE("footprints bound a part from outside and from inside")
{
    for (std::uint64_t seed = 1; seed <= 60; ++seed) {
        const Robot robot = random_robot(seed);
        Random random(seed);
        const Mat3 turn = rotation_of_rpy(0, 0, random.between(-pi, pi));
        const std::vector<Footprint> found = footprints(robot, turn, true);
        REQUIRE(found.size() == robot.parts.size());
        for (std::size_t p = 0; p < found.size(); ++p) {
            Robot part;
            part.parts = {robot.parts[p]};
            const auto inside = [](const Polygon2& polygon, const Vec2& at) {
                for (std::size_t k = 0; k < polygon.size(); ++k) {
                    const Vec2 a = polygon[k], edge = polygon[(k + 1) % polygon.size()] - a;
                    if (edge.x() * (at.y() - a.y()) - edge.y() * (at.x() - a.x()) < 0) return false;
                }
                return polygon.size() >= 3;
            };
            const Bounds box = robot.bounds();
            const double reach = std::max(box.max.norm(), box.min.norm());
            for (int i = 0; i < 200; ++i) {
                // A grain of 0.1 mm is inside the part or not, by the independent decision.
                const Vec3 at{random.between(-reach, reach), random.between(-reach, reach),
                              random.between(box.min.z() - 0.1, box.max.z() + 0.1)};
                Scene grain;
                hand::add_shape(grain, Label::Obstacle, box_at({1e-4, 1e-4, 1e-4}, at));
                const bool solid = slow::collides(grain, part, {Vec3::Zero(), turn}, 0);
                const auto in_prism = [&](const Prism& prism) {
                    return inside(prism.polygon, at.head<2>()) && at.z() > prism.bottom && at.z() < prism.top;
                };
                CAPTURE(seed, p, at.transpose());
                if (in_prism(found[p].inner)) CHECK(solid);
                const bool deep = slow::collides(grain, part, {Vec3::Zero(), turn}, -2e-4);
                if (deep) CHECK(in_prism(found[p].outer));
            }
        }
    }
}
