#include "robot/convex_split.h"

#include "base/parallel.h"
#include "robot/hull.h"

#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <stdexcept>

namespace spawnfield {
namespace {

constexpr int even_cuts = 15;           // per axis, at equal distances from each other
constexpr std::size_t vertex_cuts = 8;  // vertices per axis that get a cut on either side
// A cut that saves at most this share of the volume of the uncut hull is undone, unless a later cut of one of its sides
// is kept.
constexpr double least_gain = 1e-3;

constexpr double infinite = std::numeric_limits<double>::infinity();

struct Plane {
    int axis = 0;
    double offset = 0;
};

/// Adds the part of a triangle that lies on one side of a plane (side -1: below, 1: above) or on the plane, as a fan of
/// triangles.
void clip(const Corners& triangle, const Plane& plane, double side, std::vector<Corners>& out)
{
    std::array<Vec3, 4> kept;
    std::size_t count = 0;
    for (std::size_t k = 0; k < 3; ++k) {
        const Vec3 &p = triangle[k], &q = triangle[(k + 1) % 3];
        const double dp = side * (p[plane.axis] - plane.offset), dq = side * (q[plane.axis] - plane.offset);
        if (dp >= 0) kept[count++] = p;
        if ((dp < 0 && dq > 0) || (dp > 0 && dq < 0)) {
            // Interpolates from the lower end, so that both sides of the plane and both triangles of an edge get the
            // same point.
            const Vec3 &low = dp * side < dq * side ? p : q, &high = dp * side < dq * side ? q : p;
            kept[count] = low + (plane.offset - low[plane.axis]) / (high[plane.axis] - low[plane.axis]) * (high - low);
            kept[count++][plane.axis] = plane.offset;
        }
    }
    for (std::size_t k = 1; k + 1 < count; ++k) out.push_back({kept[0], kept[k], kept[k + 1]});
}

/// Returns whether a ray from the point meets the triangle. Source: Moeller, Trumbore, Fast, Minimum Storage
/// Ray/Triangle Intersection, 1997.
bool is_met(const Corners& triangle, const Vec3& point, const Vec3& direction)
{
    const Vec3 e = triangle[1] - triangle[0], f = triangle[2] - triangle[0], normal = direction.cross(f);
    const double det = e.dot(normal);
    if (det == 0) return false;
    const Vec3 from = point - triangle[0], across = from.cross(e);
    const double u = from.dot(normal) / det, v = direction.dot(across) / det;
    return u >= 0 && v >= 0 && u + v <= 1 && f.dot(across) / det > 0;
}

/// Returns whether the point is inside a piece: a ray from it meets the piece an odd number of times. The winding of
/// the triangles does not matter. A ray through an edge may be counted wrongly, so three rays are tried and one odd
/// count is enough: a point that is wrongly added only makes a hull larger.
bool is_inside(const std::vector<SurfacePiece>& pieces, const Vec3& point)
{
    const std::array<Vec3, 3> directions{Vec3(0.8, 0.53, 0.27), Vec3(-0.36, 0.41, 0.87), Vec3(0.29, -0.93, 0.19)};
    for (const SurfacePiece& piece : pieces)
        for (const Vec3& direction : directions)
            if (std::count_if(piece.begin(), piece.end(),
                              [&](const Corners& t) { return is_met(t, point, direction); }) %
                    2 ==
                1)
                return true;
    return false;
}

/// The part of the pieces that lies in a box.
struct Block {
    Bounds box{Vec3::Constant(-infinite), Vec3::Constant(infinite)};
    std::vector<Corners> triangles;
    std::vector<Vec3> corners;  ///< corners of the box that lie inside a piece
    RobotPart hull;
    double volume = 0;
    int children[2] = {-1, -1};

    bool is_leaf() const { return children[0] < 0; }
};

/// Computes the block's hull and its volume. Throws std::domain_error if the hull has no volume.
void add_hull(Block& block)
{
    std::vector<Vec3> points = block.corners;
    for (const Corners& triangle : block.triangles) points.insert(points.end(), triangle.begin(), triangle.end());
    block.hull = convex_hull(points);
    block.volume = hull_volume(block.hull);
}

/// Cuts the box by a plane. Returns those corners of the cut rectangle that lie inside a piece.
std::vector<Vec3> inner_corners(const std::vector<SurfacePiece>& pieces, const Bounds& box, const Plane& plane)
{
    std::vector<Vec3> out;
    const int u = (plane.axis + 1) % 3, v = (plane.axis + 2) % 3;
    for (const double at_u : {box.min[u], box.max[u]})
        for (const double at_v : {box.min[v], box.max[v]}) {
            Vec3 corner;
            corner[plane.axis] = plane.offset;
            corner[u] = at_u;
            corner[v] = at_v;
            if (corner.allFinite() && is_inside(pieces, corner)) out.push_back(corner);
        }
    return out;
}

/// Returns the two sides of a block that is cut by a plane; nothing if one of them has no volume.
std::optional<std::array<Block, 2>> sides_of(const Block& block, const Plane& plane,
                                             const std::vector<SurfacePiece>& pieces)
{
    std::array<Block, 2> sides;
    const std::vector<Vec3> on_plane = inner_corners(pieces, block.box, plane);
    for (int k = 0; k < 2; ++k) {
        Block& side = sides[std::size_t(k)];
        side.box = block.box;
        (k == 0 ? side.box.max : side.box.min)[plane.axis] = plane.offset;
        side.corners = on_plane;
        const double kept = (k == 0 ? block.box.min : block.box.max)[plane.axis];
        for (const Vec3& corner : block.corners)
            if (corner[plane.axis] == kept) side.corners.push_back(corner);
        for (const Corners& triangle : block.triangles) clip(triangle, plane, k == 0 ? -1 : 1, side.triangles);
        try {
            add_hull(side);
        } catch (const std::domain_error&) {
            return std::nullopt;
        }
    }
    return sides;
}

/// Returns planes at equal distances, and planes just beside vertices, where walls often are. Each plane is moved by a
/// small distance, which differs from plane to plane. So it is very unlikely that a plane goes through a vertex, or
/// that three planes meet on a face, where rounding would decide what is inside.
std::vector<Plane> planes_through(const Block& block)
{
    std::vector<Plane> out;
    const Bounds bounds = block.hull.bounds();
    const auto aside = [&](double length) {  // next distance: 0.5 .. 1.5 millionths of the length
        const double turn = std::numbers::phi * double(out.size() + 1);
        return 1e-6 * length * (0.5 + turn - std::floor(turn));
    };
    for (int axis = 0; axis < 3; ++axis) {
        const double low = bounds.min[axis], length = bounds.max[axis] - low;
        for (int k = 1; k <= even_cuts; ++k) out.push_back({axis, low + k * length / (even_cuts + 1) + aside(length)});
        std::vector<double> places;
        for (const Corners& triangle : block.triangles)
            for (const Vec3& corner : triangle)
                if (corner[axis] > low + 1e-5 * length && corner[axis] < low + (1 - 1e-5) * length)
                    places.push_back(corner[axis]);
        std::sort(places.begin(), places.end());
        places.erase(std::unique(places.begin(), places.end()), places.end());
        const std::size_t count = std::min(vertex_cuts, places.size());
        for (std::size_t k = 0; k < count; ++k)
            for (const double side : {-1.0, 1.0})
                out.push_back({axis, places[k * places.size() / count] + side * aside(length)});
    }
    return out;
}

/// Returns the cut after which the least volume remains. Among equal cuts it prefers one across the longest side,
/// through the middle.
std::optional<std::array<Block, 2>> best_cut(const Block& block, const std::vector<SurfacePiece>& pieces)
{
    const std::vector<Plane> planes = planes_through(block);
    const Vec3 size = block.hull.bounds().max - block.hull.bounds().min;
    std::vector<double> scores(planes.size(), infinite);
    parallel_for(planes.size(), 0, {}, [&](std::size_t k) {
        const auto sides = sides_of(block, planes[k], pieces);
        if (!sides) return;
        const double left = (*sides)[0].volume, right = (*sides)[1].volume;
        const double shortness = 1 - size[planes[k].axis] / size.maxCoeff();
        scores[k] = left + right + 1e-6 * (std::abs(left - right) + 2 * shortness * block.volume);
    });
    const auto best = std::min_element(scores.begin(), scores.end());
    if (best == scores.end() || *best == infinite) return std::nullopt;
    return sides_of(block, planes[std::size_t(best - scores.begin())], pieces);
}

/// Cuts pieces into blocks, greedily, and joins the blocks whose cuts were useless.
class Splitter {
public:
    Splitter(const std::vector<SurfacePiece>& pieces, int most) : pieces_(pieces), most_(most)
    {
        Block whole;
        for (const SurfacePiece& piece : pieces)
            whole.triangles.insert(whole.triangles.end(), piece.begin(), piece.end());
        add_hull(whole);
        blocks_.push_back(std::move(whole));
    }

    std::vector<RobotPart> split()
    {
        const double whole = blocks_[0].volume;
        std::vector<std::optional<std::array<Block, 2>>> cuts;
        // Makes almost twice as many blocks as wanted, because cutting a ring saves nothing before there are four
        // blocks. Then undoes the cuts that saved least.
        for (int leaves = 1; most_ > 1 && leaves < 2 * most_; ++leaves) {
            for (std::size_t k = cuts.size(); k < blocks_.size(); ++k) cuts.push_back(best_cut(blocks_[k], pieces_));
            const int next = next_block(cuts);
            if (next < 0) break;
            for (int side = 0; side < 2; ++side) {
                blocks_[std::size_t(next)].children[side] = int(blocks_.size());
                blocks_.push_back(std::move((*cuts[std::size_t(next)])[std::size_t(side)]));
            }
        }
        while (undo_worst(least_gain * whole)) continue;
        std::vector<RobotPart> out;
        collect(0, out);
        return out;
    }

private:
    static double saved(const Block& block, const std::array<Block, 2>& sides)
    {
        return block.volume - sides[0].volume - sides[1].volume;
    }

    /// Returns the leaf whose cut saves most volume, or the largest leaf if no cut saves any; -1 if no leaf can be cut.
    int next_block(const std::vector<std::optional<std::array<Block, 2>>>& cuts) const
    {
        int best = -1;
        double best_gain = 0, best_volume = 0;
        for (std::size_t k = 0; k < blocks_.size(); ++k) {
            if (!blocks_[k].is_leaf() || !cuts[k]) continue;
            const double gain = saved(blocks_[k], *cuts[k]), volume = blocks_[k].volume;
            const bool tie = std::abs(gain - best_gain) <= 1e-6 * blocks_[0].volume;
            if (best >= 0 && !(tie ? volume > best_volume : gain > best_gain)) continue;
            best = int(k);
            best_gain = gain;
            best_volume = volume;
        }
        return best;
    }

    /// Joins the two leaves whose cut saves least, if there are too many leaves or if the cut saves at most `enough`,
    /// m3. Returns whether it joined any.
    bool undo_worst(double enough)
    {
        int worst = -1, leaves = 0;
        double least = 0;
        for (std::size_t k = 0; k < blocks_.size(); ++k) {
            if (!is_used(k)) continue;
            if (blocks_[k].is_leaf()) {
                ++leaves;
                continue;
            }
            const Block &left = blocks_[std::size_t(blocks_[k].children[0])],
                        &right = blocks_[std::size_t(blocks_[k].children[1])];
            if (!left.is_leaf() || !right.is_leaf()) continue;
            const double gain = blocks_[k].volume - left.volume - right.volume;
            if (worst >= 0 && gain >= least) continue;
            worst = int(k);
            least = gain;
        }
        if (worst < 0 || (leaves <= most_ && least > enough)) return false;
        for (int& child : blocks_[std::size_t(worst)].children) {
            unused_.push_back(std::size_t(child));
            child = -1;
        }
        return true;
    }

    bool is_used(std::size_t block) const { return std::find(unused_.begin(), unused_.end(), block) == unused_.end(); }

    void collect(int block, std::vector<RobotPart>& out) const
    {
        const Block& here = blocks_[std::size_t(block)];
        if (here.is_leaf())
            out.push_back(here.hull);
        else
            for (const int child : here.children) collect(child, out);
    }

    const std::vector<SurfacePiece>& pieces_;
    const int most_;
    std::vector<Block> blocks_;
    std::vector<std::size_t> unused_;
};

}  // namespace

std::vector<RobotPart> convex_split(const std::vector<SurfacePiece>& pieces, int most)
{
    return Splitter(pieces, most).split();
}

double hull_volume(const RobotPart& hull)
{
    const Vec3 centre = hull.centre();
    double six = 0;
    for (const auto& face : hull.hull_faces) {
        const auto corner = [&](std::size_t k) { return Vec3(hull.hull_vertices[std::size_t(face[k])] - centre); };
        six += corner(0).dot(corner(1).cross(corner(2)));
    }
    return six / 6;
}

}  // namespace spawnfield
