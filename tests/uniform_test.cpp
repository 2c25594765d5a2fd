#include "catch.h"
#include "column/cell_clip.h"
#include "column/uniform_column.h"
#include "free_space/bounds_tile.h"
#include "random_scene.h"
#include "test_map.h"
#include "worlds/hand_scene.h"

using namespace spawnfield;

namespace {

/// Two level planes, one of them smaller, a pool, a box, and a slope.
Scene planes()
{
    Scene scene;
    hand::add_mesh(scene, Label::Terrain, hand::rectangle(40, 40));
    const auto at = [](const Vec3& position) { return Pose{position, Mat3::Identity()}; };
    hand::add_mesh(scene, Label::Terrain, hand::moved(hand::rectangle(20, 20), at({-10, -10, 0.06})));
    hand::add_mesh(scene, Label::Water, hand::moved(hand::rectangle(20, 20), at({10, -10, 0.5})));
    hand::add_mesh(scene, Label::Obstacle, hand::moved(hand::box({2, 2, 2}), at({10, 10, 1})));
    hand::add_mesh(scene, Label::Terrain,
                   hand::moved(hand::rectangle(4, 4), {{-10, 10, 1}, rotation_from_rpy(0.1, 0, 0)}));
    return scene;
}

Rect around(double x, double y, double half) { return {x - half, y - half, x + half, y + half}; }

/// Returns whether all cells of the rectangle have exactly the surfaces of a column, as the mask and the OctoMap
/// assume.
bool has_surfaces_of(const Geometry& geometry, const Rect& rect, const Column& column)
{
    const CellBlock block{rect.low_x, rect.low_y, (rect.high_x - rect.low_x) / 3, 3, 3};
    const CellSpans surfaces(geometry, block);
    std::vector<Interval> found;
    for (std::uint32_t cell = 0; cell < 9; ++cell) {
        surfaces.get(cell, found);
        if (found != solid_intervals(column)) return false;
    }
    return true;
}

/// Some lists of intervals, shared by many cells.
CellList random_list(Random& random, int patterns, std::size_t most)
{
    std::vector<std::vector<Interval>> lists(static_cast<std::size_t>(patterns));
    for (auto& list : lists) {
        double z = random.between(-5, 5);
        for (int n = random.below(int(most) + 1); n > 0; --n) {
            const double bottom = z + random.between(0.01, 2), top = bottom + random.between(0, 2);
            list.push_back({bottom, top});
            z = top;
        }
    }
    CellList out;
    std::size_t pattern = 0;
    for (std::size_t cell = 0; cell < BoundsTile::cells; ++cell) {
        if (random.chance(0.1)) pattern = std::size_t(random.below(patterns));
        out.spans.insert(out.spans.end(), lists[pattern].begin(), lists[pattern].end());
        out.starts[cell + 1] = std::uint32_t(out.spans.size());
    }
    return out;
}

/// Returns the lowest interval of each cell that has several, as solids are inside the bounds.
CellList lowest_of(const CellList& bounds)
{
    CellList out;
    for (std::uint32_t cell = 0; cell < BoundsTile::cells; ++cell) {
        const auto spans = bounds.of(cell);
        if (spans.size() > 1) out.spans.push_back(spans.front());
        out.starts[cell + 1] = std::uint32_t(out.spans.size());
    }
    return out;
}

/// Checks the heights of every cell against those before packing.
void check_packed(const LooseTile& loose)
{
    const std::string bytes = packed(loose);
    REQUIRE(BoundsTile::is_consistent(bytes));
    const BoundsTile tile(bytes);
    const double step = tile.quantum * (1 + 1e-6);
    std::size_t wrong = 0;
    for (std::uint32_t cell = 0; cell < BoundsTile::cells; ++cell) {
        const auto bounds = loose.bounds.of(cell), solids = loose.solids.of(cell);
        const double top = tile.height(tile.tops[cell]);
        wrong += bounds.empty() ? tile.tops[cell] != 0 : top < bounds.back().top || top > bounds.back().top + step;
        wrong += tile.bounds.has(cell) != (bounds.size() >= 2);
        wrong += tile.solids.has(cell) == solids.empty();
        if (tile.bounds.has(cell)) {
            const auto found = tile.bounds.of(cell);
            REQUIRE(found.size() == bounds.size());
            for (std::size_t k = 0; k < found.size(); ++k) {
                const double low = tile.height(found[k].bottom), high = tile.height(found[k].top);
                wrong += low > bounds[k].bottom || low < bounds[k].bottom - step;
                wrong += high < bounds[k].top || high > bounds[k].top + step;
            }
        }
        if (tile.solids.has(cell)) {
            const auto found = tile.solids.of(cell);
            REQUIRE(found.size() == solids.size());
            for (std::size_t k = 0; k < found.size(); ++k) {
                wrong += tile.height(found[k].bottom) < solids[k].bottom;
                wrong += tile.height(found[k].top) > solids[k].top;
            }
        }
    }
    CHECK(wrong == 0);
}

}  // namespace

TEST_CASE(
    "a rectangle has a uniform column only where level planes cover all of it, and it is the column of its points")
{
    const Geometry geometry(planes());
    // Away from edges and from the diagonals of the rectangles:
    for (const auto& [x, y] : {std::pair{5.0, 10.0}, {-15.0, -8.0}, {7.0, -16.0}, {30.0, 30.0}}) {
        const auto same = uniform_column(geometry, around(x, y, 1));
        CAPTURE(x, y);
        REQUIRE(same.has_value());
        CHECK(*same == column_at(geometry, x, y));
    }
    CHECK(uniform_column(geometry, around(30, 30, 1))->spans.empty());
    CHECK(uniform_column(geometry, around(-15, -8, 1))->layers == std::vector<double>{0.06, 0});
    CHECK(uniform_column(geometry, around(7, -16, 1))->water == std::vector<double>{0.5});
    CHECK_FALSE(uniform_column(geometry, around(10, 10, 0.5)));   // in the box
    CHECK_FALSE(uniform_column(geometry, around(12, 10, 1)));     // touches the box
    CHECK_FALSE(uniform_column(geometry, around(-10, 10, 0.5)));  // on the slope
    CHECK_FALSE(uniform_column(geometry, around(0, -5, 0.5)));    // the edge of two planes
    CHECK_FALSE(uniform_column(geometry, around(20, 5, 0.5)));    // the edge of the largest plane
    CHECK_FALSE(uniform_column(geometry, around(5, -5, 0.5)));    // the diagonal of the largest plane

    Random random(3);
    int found = 0, wrong = 0;
    for (int n = 0; n < 3000; ++n) {
        const Rect rect = around(random.between(-22, 22), random.between(-22, 22), random.between(0.01, 3));
        const auto same = uniform_column(geometry, rect);
        if (!same) continue;
        ++found;
        wrong += !has_surfaces_of(geometry, rect, *same);
        for (int k = 0; k < 5; ++k)
            wrong += *same != column_at(geometry, random.between(rect.low_x, rect.high_x),
                                        random.between(rect.low_y, rect.high_y));
    }
    CHECK(found > 500);
    CHECK(wrong == 0);
}

TEST_CASE("a rectangle that a vertical wall crosses is not uniform, however its corners are rounded")
{
    Random random(11);
    int crossed = 0, wrong = 0;
    for (int n = 0; n < 400; ++n) {
        // Half a wall from `from` to `to`, 5 m high there. Its upper corner is up to 2 ulp beside the lower one.
        const Eigen::Vector2d from = random.chance(0.5)
                                         ? Eigen::Vector2d(0, 0)
                                         : Eigen::Vector2d(random.between(-50, 50), random.between(-50, 50));
        const Eigen::Vector2d to(random.between(-110, 110), random.between(-110, 110));
        const auto noisy = [&](double value) {
            for (int k = random.below(3); k > 0; --k) value = std::nextafter(value, random.chance(0.5) ? 1e9 : -1e9);
            return value;
        };
        const double x = noisy(to.x()), y = noisy(to.y());
        Scene scene;
        hand::add_mesh(scene, Label::Terrain, hand::rectangle(400, 400));
        hand::add_mesh(scene, Label::Obstacle,
                       {{{from.x(), from.y(), 0}, {to.x(), to.y(), 0}, {x, y, 5}}, {{0, 1, 2}}});
        const Geometry geometry(scene);
        for (int k = 0; k < 20; ++k) {
            const Eigen::Vector2d at = from + random.between(0.02, 0.98) * (to - from);
            const double half = random.between(0.01, 3);
            const Eigen::Vector2d centre = at +
                                           Eigen::Vector2d(random.between(-half, half), random.between(-half, half));
            ++crossed;
            wrong += uniform_column(geometry, around(centre.x(), centre.y(), half)).has_value();
        }
    }
    CHECK(crossed == 8000);
    CHECK(wrong == 0);
}

TEST_CASE("a triangle at a height of -0 m is not uniform, because its computed heights may be 0 m or -0 m")
{
    Scene scene;
    hand::add_mesh(scene, Label::Terrain, hand::moved(hand::rectangle(40, 40), {{0, 0, -0.0}, Mat3::Identity()}));
    for (Vec3& corner : scene.vertices) corner.z() = -0.0;
    CHECK_FALSE(uniform_column(Geometry(scene), around(5, 10, 1)));
}

TEST_CASE("packed tiles bound the heights of each cell, with lists of their own, with shared lists, and if uniform")
{
    Random random(8);
    for (const int patterns : {1, 3, 40, 3000}) {
        CAPTURE(patterns);
        for (int n = 0; n < 5; ++n) {
            LooseTile loose;
            loose.bounds = random_list(random, patterns, 4);
            loose.solids = lowest_of(loose.bounds);
            if (!loose.is_empty()) check_packed(loose);
        }
    }
    LooseTile uniform;
    uniform.bounds.spans = {{-2, -1}, {0, 0}, {0.06, 0.06}};
    uniform.bounds.starts[1] = 3;
    uniform.bounds.repeat_first();
    check_packed(uniform);
    CHECK(packed(uniform).size() < 128);
    uniform.bounds.spans = {{7, 7}};
    uniform.bounds.starts[1] = 1;
    uniform.bounds.repeat_first();
    check_packed(uniform);
    CHECK(packed(uniform).size() < 128);
}

TEST_CASE("tiles with shared lists take less memory, and damaged ones are refused")
{
    Random random(5);
    LooseTile loose;
    loose.bounds = random_list(random, 2, 4);
    while (loose.bounds.spans.size() < 2 * BoundsTile::cells) loose.bounds = random_list(random, 2, 4);
    const std::string bytes = packed(loose);
    CHECK(bytes.size() < 8 * loose.bounds.spans.size());
    BoundsHead head;
    std::memcpy(&head, bytes.data(), sizeof head);
    REQUIRE(head.bound_lists > 0);
    const auto is_refused = [&](auto change) {
        std::string bad = bytes;
        BoundsHead changed = head;
        change(changed, bad);
        std::memcpy(bad.data(), &changed, sizeof changed);
        return !BoundsTile::is_consistent(bad);
    };
    CHECK_FALSE(is_refused([](BoundsHead&, std::string&) {}));
    CHECK(is_refused([](BoundsHead& h, std::string&) { ++h.bound_cells; }));
    CHECK(is_refused([](BoundsHead& h, std::string&) { h.bound_lists = 0; }));
    CHECK(is_refused([](BoundsHead& h, std::string&) { h.bound_lists = 5000; }));
    CHECK(is_refused([](BoundsHead& h, std::string&) { --h.bounds; }));
    CHECK(is_refused([](BoundsHead& h, std::string&) { h.is_uniform = 1; }));
    CHECK(is_refused([](BoundsHead& h, std::string&) { h.quantum = 0; }));
    CHECK(is_refused([](BoundsHead& h, std::string&) { h.quantum = std::numeric_limits<double>::infinity(); }));
    CHECK(is_refused([](BoundsHead& h, std::string&) { h.quantum = 1e-310; }));
    CHECK(is_refused([&](BoundsHead&, std::string& bad) {  // the number of the last cell's list
        const std::size_t end = bytes.size() - BoundsTile::cells * sizeof(std::uint16_t);
        for (std::size_t at = end - 16; at < end; ++at) bad[at] = char(0xff);
    }));
}
