#include "catch.h"
#include "collision/box_triangle.h"

#include <spawnfield/free_space.h>

#include <Eigen/Geometry>

#include <cmath>
#include <random>
#include <vector>

using namespace spawnfield;

namespace {

using Triangle3 = std::array<Vec3, 3>;

/// Returns whether a triangle meets the box -half .. half: cuts the triangle by the six planes of the box (Sutherland,
/// Hodgman, Reentrant polygon clipping, 1974) and looks whether something is left.
bool meets(const Vec3& half, const Triangle3& triangle)
{
    std::vector<Vec3> polygon(triangle.begin(), triangle.end());
    for (int axis = 0; axis < 3; ++axis)
        for (const double sign : {-1.0, 1.0}) {
            std::vector<Vec3> rest;
            for (std::size_t k = 0; k < polygon.size(); ++k) {
                const Vec3 &p = polygon[k], &q = polygon[(k + 1) % polygon.size()];
                const double beyond_p = sign * p[axis] - half[axis], beyond_q = sign * q[axis] - half[axis];
                if (beyond_p <= 0) rest.push_back(p);
                if ((beyond_p < 0) != (beyond_q < 0) && beyond_p != beyond_q)
                    rest.push_back(p + beyond_p / (beyond_p - beyond_q) * (q - p));
            }
            polygon = std::move(rest);
        }
    return !polygon.empty();
}

/// Moves along a random direction by a random length between 1e-6 and `most` times a size.
Vec3 random_step(std::mt19937& random, double most)
{
    std::normal_distribution<double> normal;
    std::uniform_real_distribution<double> exponent(-6, std::log10(most));
    return Vec3(normal(random), normal(random), normal(random)).normalized() * std::pow(10, exponent(random));
}

/// Corners near the surface of a box, at all distances between them. Some triangles have edges along the axes, and some
/// are nearly parallel to them.
Triangle3 random_triangle(std::mt19937& random, const Vec3& half)
{
    std::uniform_real_distribution<double> within(-1.2, 1.2);
    std::uniform_int_distribution<int> kind(0, 5);
    const Vec3 first(within(random) * half.x(), within(random) * half.y(), within(random) * half.z());
    Triangle3 out{first, first + random_step(random, 1e3), first + random_step(random, 1e3)};
    const int chosen = kind(random);
    const Vec3 axis = Vec3::Unit(std::uniform_int_distribution<int>(0, 2)(random));
    if (chosen == 0) out[1] = first + axis * (out[1] - first).norm();
    if (chosen == 1) out[2].z() = out[1].z() = first.z();
    if (chosen == 3) out[1] = first + (axis + 1e-3 * random_step(random, 1)) * (out[1] - first).norm();
    if (chosen == 2) out[2] = first + 3 * (out[1] - first) + random_step(random, 1e-2);
    return out;
}

/// Returns whether no angle of the triangle is very small, and no edge is nearly, but not exactly, parallel to an axis:
/// angles are at least `least`, rad.
bool is_regular(const Triangle3& triangle, double least = 1e-6)
{
    double longest = 0;
    for (std::size_t k = 0; k < 3; ++k) {
        const Vec3 edge = triangle[(k + 1) % 3] - triangle[k];
        longest = std::max(longest, edge.norm());
        for (int axis = 0; axis < 3; ++axis) {
            const double across = Vec3::Unit(axis).cross(edge).norm();
            if (across != 0 && across < least * edge.norm()) return false;
        }
    }
    const Vec3 normal = (triangle[1] - triangle[0]).cross(triangle[2] - triangle[0]);
    return normal.norm() > least * longest * longest;
}

}  // namespace

TEST_CASE(
    "the fast test of a box and a triangle is right wherever it claims something, and clear about regular triangles")
{
    constexpr double margin = FreeSpace::margin;
    std::mt19937 random(1);
    std::uniform_real_distribution<double> size(0.05, 2);
    std::array<int, 3> counts{};
    int clear = 0;
    for (int n = 0; n < 300000; ++n) {
        const Vec3 half(size(random), size(random), size(random));
        const Triangle3 triangle = random_triangle(random, half);
        const AxisTest result = axis_test(half, triangle);
        ++counts[std::size_t(result)];
        const auto meets_grown_by = [&](double by) { return meets(half + Vec3::Constant(by), triangle); };
        // A gap of more than the margin is more than margin / sqrt(3) along some axis of the box.
        if (result == AxisTest::Apart && meets_grown_by(margin / 2)) FAIL("apart, but they meet: case " << n);
        if (result == AxisTest::Overlap && !meets_grown_by(-margin)) FAIL("overlap, but they do not: case " << n);
        const bool is_far = !meets_grown_by(2 * margin), is_deep = meets_grown_by(-3 * margin);
        if (!is_regular(triangle) || (!is_far && !is_deep)) continue;
        ++clear;
        if (result == AxisTest::Unclear) FAIL("unclear, but the distance is large: case " << n);
    }
    CHECK(counts[std::size_t(AxisTest::Apart)] > 50000);
    CHECK(counts[std::size_t(AxisTest::Overlap)] > 50000);
    CHECK(clear > 150000);
}

TEST_CASE("the fast test of a box and a triangle knows touching, thin and flat cases")
{
    const Vec3 half(0.5, 0.3, 0.2);
    const auto at_height = [&](double z) { return axis_test(half, {Vec3(-9, -9, z), Vec3(9, -9, z), Vec3(0, 9, z)}); };
    CHECK(at_height(0) == AxisTest::Overlap);
    CHECK(at_height(0.19) == AxisTest::Overlap);
    CHECK(at_height(0.2) == AxisTest::Unclear);
    CHECK(at_height(0.200005) == AxisTest::Unclear);
    CHECK(at_height(0.20002) == AxisTest::Apart);
    CHECK(axis_test(half, {Vec3::Zero(), Vec3::Zero(), Vec3::Zero()}) == AxisTest::Unclear);
    CHECK(axis_test(half, {Vec3(0, 0, 0), Vec3(1, 0, 0), Vec3(2, 0, 0)}) == AxisTest::Unclear);
    CHECK(axis_test(half, {Vec3(0, 0, 1), Vec3(1, 0, 1), Vec3(2, 0, 1)}) == AxisTest::Apart);
    // Only the cross product of an edge of the box and an edge of the triangle separates these.
    CHECK(axis_test({1, 1, 1}, {Vec3(1.6, 0.3, 2), Vec3(0.3, 1.6, -2), Vec3(9, 9, 0)}) == AxisTest::Overlap);
    CHECK(axis_test({1, 1, 1}, {Vec3(2.2, 0, 2), Vec3(0, 2.2, -2), Vec3(9, 9, 0)}) == AxisTest::Apart);
}

TEST_CASE("the fast test of four triangles is right wherever it claims something, and mostly clear for small triangles")
{
    constexpr double margin = FreeSpace::margin;
    std::mt19937 random(2);
    std::normal_distribution<double> normal;
    std::uniform_real_distribution<double> size(0.05, 2);
    int apart = 0, overlap = 0, small = 0, clear = 0;
    for (int n = 0; n < 75000; ++n) {
        const Vec3 half(size(random), size(random), size(random));
        const Vec3 origin = 1000 * Vec3(normal(random), normal(random), normal(random));
        Pose origin_from_box{Vec3(normal(random), normal(random), normal(random)), Mat3::Identity()};
        if (n % 3 == 0)
            origin_from_box.rotation = Eigen::Quaterniond(normal(random), normal(random), normal(random),
                                                          normal(random))
                                           .normalized()
                                           .toRotationMatrix();
        else if (n % 3 == 1)  // upright
            origin_from_box.rotation = Eigen::AngleAxisd(normal(random), Vec3::UnitZ()).toRotationMatrix();
        std::array<Triangle3, FourTriangles::width> triangles, placed;
        std::array<std::array<const Vec3*, 3>, FourTriangles::width> corners;
        for (std::size_t t = 0; t < triangles.size(); ++t) {
            triangles[t] = random_triangle(random, half);
            for (std::size_t k = 0; k < 3; ++k) {
                placed[t][k] = origin + (origin_from_box.rotation * triangles[t][k] + origin_from_box.position);
                corners[t][k] = &placed[t][k];
            }
        }
        const FourTriangles::Marks marks = FourTriangles(corners, origin).compare(FourBoxes(half, origin_from_box));
        if ((marks.apart & marks.overlap) != 0 || ((marks.apart | marks.overlap) >> FourTriangles::width) != 0)
            FAIL("marks that contradict each other: case " << n);
        for (std::size_t t = 0; t < triangles.size(); ++t) {
            const auto meets_grown_by = [&](double by) { return meets(half + Vec3::Constant(by), triangles[t]); };
            const bool is_apart = (marks.apart >> t & 1) != 0, is_overlap = (marks.overlap >> t & 1) != 0;
            if (is_apart && meets_grown_by(margin / 2)) FAIL("apart, but they meet: case " << n);
            if (is_overlap && !meets_grown_by(-margin)) FAIL("overlap, but they do not: case " << n);
            apart += is_apart;
            overlap += is_overlap;
            const auto& [a, b, c] = triangles[t];
            const double longest = std::max({(b - a).norm(), (c - b).norm(), (a - c).norm()});
            if (longest > 3 || longest < 0.1 || !is_regular(triangles[t], 0.1)) continue;
            ++small;
            clear += is_apart || is_overlap;
        }
    }
    CAPTURE(apart, overlap, small, clear);
    CHECK(apart > 50000);
    CHECK(overlap > 30000);
    CHECK(small > 4000);
    CHECK(clear > 0.9 * small);
}

TEST_CASE("the fast test of four triangles knows touching, thin and flat cases")
{
    const FourBoxes box({0.5, 0.3, 0.2}, {});
    const auto test = [&](const Triangle3& triangle) {
        const std::array<const Vec3*, 3> corners{&triangle[0], &triangle[1], &triangle[2]};
        const auto [apart, overlap] = FourTriangles({corners, corners, corners, corners}, Vec3::Zero()).compare(box);
        CHECK((apart == 0 || apart == 15));
        CHECK((overlap == 0 || overlap == 15));
        return apart != 0 ? AxisTest::Apart : overlap != 0 ? AxisTest::Overlap : AxisTest::Unclear;
    };
    const auto at_height = [&](double z) { return test({Vec3(-1, -1, z), Vec3(1, -1, z), Vec3(0, 1, z)}); };
    CHECK(at_height(0) == AxisTest::Overlap);
    CHECK(at_height(0.199) == AxisTest::Overlap);
    CHECK(at_height(0.2) == AxisTest::Unclear);
    CHECK(at_height(0.20001) == AxisTest::Unclear);
    CHECK(at_height(0.201) == AxisTest::Apart);
    CHECK(test({Vec3::Zero(), Vec3::Zero(), Vec3::Zero()}) == AxisTest::Unclear);
    CHECK(test({Vec3(0, 0, 0), Vec3(1, 0, 0), Vec3(2, 0, 0)}) == AxisTest::Unclear);
    CHECK(test({Vec3(0, 0, 1), Vec3(1, 0, 1), Vec3(2, 0, 1)}) == AxisTest::Apart);
    const double nan = std::nan(""), huge = 1e30;
    CHECK(test({Vec3(nan, 0, 0), Vec3(1, 0, 0), Vec3(0, 1, 0)}) == AxisTest::Unclear);
    CHECK(test({Vec3(-huge, -huge, 0), Vec3(huge, -huge, 0), Vec3(0, huge, 0)}) == AxisTest::Unclear);
    // Only the cross product of an edge of the box and an edge of the triangle separates these.
    const FourBoxes cube({1, 1, 1}, {});
    const auto compared = [&](const Triangle3& triangle) {
        const std::array<const Vec3*, 3> corners{&triangle[0], &triangle[1], &triangle[2]};
        return FourTriangles({corners, corners, corners, corners}, Vec3::Zero()).compare(cube);
    };
    CHECK(compared({Vec3(1.6, 0.3, 2), Vec3(0.3, 1.6, -2), Vec3(9, 9, 0)}).overlap == 15);
    CHECK(compared({Vec3(2.2, 0, 2), Vec3(0, 2.2, -2), Vec3(9, 9, 0)}).apart == 15);
}
