#include "audit/solid_depth.h"

#include "column/columns.h"
#include "settle/convex_distance.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <queue>

namespace spawnfield {
namespace {

constexpr double depth_precision = 1e-7;  // m, of a radius

/// Returns the radius of the largest sphere that fits into a shape, m.
double inner_radius(const Shape& shape)
{
    const Vec3& size = shape.size;
    if (shape.kind == ShapeKind::Box) return size.minCoeff() / 2;
    return shape.kind == ShapeKind::Cylinder ? std::min(size[0], size[1] / 2) : size[0];
}

/// Returns the points of a shape that are at least `by` (m, at most inner_radius) from its surface.
Shape shrunk(const Shape& shape, double by)
{
    Shape out = shape;
    if (shape.kind == ShapeKind::Box)
        out.size.array() -= 2 * by;
    else
        out.size[0] -= by;
    if (shape.kind == ShapeKind::Cylinder) out.size[1] -= 2 * by;
    out.size = out.size.cwiseMax(0);
    return out;
}

SharedDepth depth_of_primitives(const Shape& a, const Shape& b, double least)
{
    const Vec3 origin = a.pose.position;
    const auto body = [&](const Shape& shape, double by) {
        return moved(convex_of(shrunk(shape, by)), {-origin, Mat3::Identity()});
    };
    const auto fits = [&](double radius) {
        return shortest_way(body(a, radius), body(b, radius)).norm() <= touch_tolerance;
    };
    double high = std::min(inner_radius(a), inner_radius(b)), low = least / 2 + depth_precision;
    if (!(high >= low) || !fits(low)) return {};
    if (fits(high)) low = high;
    while (high - low > depth_precision) {
        const double middle = (low + high) / 2;
        (fits(middle) ? low : high) = middle;
    }
    const Bounds in_a = bounds_of(a), in_b = bounds_of(b);
    const Vec3 from = in_a.min.cwiseMax(in_b.min), to = in_a.max.cwiseMin(in_b.max);
    return {SharedDepth::Proof::Exact, 2 * low, (from + to) / 2};
}

/// Returns the distance of a point from a triangle, m. Source: Ericson, Real-Time Collision Detection, 2005, 5.1.5.
double distance_to(const std::array<Vec3, 3>& triangle, const Vec3& p)
{
    const auto& [a, b, c] = triangle;
    const Vec3 ab = b - a, ac = c - a, ap = p - a, bp = p - b, cp = p - c;
    const double d1 = ab.dot(ap), d2 = ac.dot(ap), d3 = ab.dot(bp), d4 = ac.dot(bp), d5 = ab.dot(cp), d6 = ac.dot(cp);
    if (d1 <= 0 && d2 <= 0) return ap.norm();
    if (d3 >= 0 && d4 <= d3) return bp.norm();
    if (d6 >= 0 && d5 <= d6) return cp.norm();
    const double vc = d1 * d4 - d3 * d2, vb = d5 * d2 - d1 * d6, va = d3 * d6 - d5 * d4;
    if (vc <= 0 && d1 >= 0 && d3 <= 0) return (ap - d1 / (d1 - d3) * ab).norm();
    if (vb <= 0 && d2 >= 0 && d6 <= 0) return (ap - d2 / (d2 - d6) * ac).norm();
    if (va <= 0 && d4 >= d3 && d5 >= d6) return (bp - (d4 - d3) / ((d4 - d3) + (d5 - d6)) * (c - b)).norm();
    const Vec3 normal = ab.cross(ac);
    return std::abs(normal.dot(ap)) / normal.norm();
}

/// Returns how deep a point is inside a shape, m; outside, a number that is negative, and not less than minus its
/// distance.
double depth_in(const Shape& shape, const Vec3& point)
{
    const Vec3 p = shape.pose.rotation.transpose() * (point - shape.pose.position);
    const Vec3& size = shape.size;
    switch (shape.kind) {
    case ShapeKind::Box: return (size / 2 - p.cwiseAbs()).minCoeff();
    case ShapeKind::Cylinder: return std::min(size[0] - p.head<2>().norm(), size[1] / 2 - std::abs(p.z()));
    case ShapeKind::Capsule: {
        const double along = std::clamp(p.z(), -size[1] / 2, size[1] / 2);
        return size[0] - (p - Vec3(0, 0, along)).norm();
    }
    case ShapeKind::Sphere:
    case ShapeKind::Hull: break;
    }
    return size[0] - p.norm();
}

using TriangleList = std::vector<std::uint32_t>;

/// A box in which the centre of a sphere is searched.
struct Cell {
    Vec3 middle, half;  ///< m
    double most = 0;    ///< m: no point of the cell is deeper than this in both solids
    /// The triangles of each solid that may be the nearest one to a point of the cell.
    std::array<std::shared_ptr<const TriangleList>, 2> near;

    bool operator<(const Cell& other) const { return most < other.most; }
};

/// Searches the deepest common point of two solids.
class DepthSearch {
public:
    DepthSearch(const Geometry& geometry, const Solid3& a, const Solid3& b) : geometry_(geometry), solids_{&a, &b}
    {
        const Vec3 low = a.bounds.min.cwiseMax(b.bounds.min), high = a.bounds.max.cwiseMin(b.bounds.max);
        root_.middle = (low + high) / 2;
        root_.half = (high - low) / 2;
        reach_ = root_.half.minCoeff();  // a sphere in both boxes is not larger
        for (std::size_t s = 0; s < 2; ++s) {
            auto list = std::make_shared<TriangleList>(solids_[s]->triangles.size());
            for (std::uint32_t t = 0; t < list->size(); ++t) (*list)[t] = t;
            root_.near[s] = std::move(list);
        }
    }

    SharedDepth search(double least)
    {
        constexpr std::size_t most_cells = 40000, cells_to_improve = 1000;
        if (!(2 * reach_ > least)) return {};
        SharedDepth out;
        std::priority_queue<Cell> cells;
        const auto add = [&](Cell cell) {
            const double depth = examine(cell, std::max(least, out.depth) / 2);
            if (2 * depth > out.depth) out = {out.proof, 2 * depth, cell.middle};
            if (2 * cell.most > least) cells.push(std::move(cell));
        };
        add(root_);
        std::size_t examined = 0, since_found = 0;
        while (!cells.empty() && 2 * cells.top().most > std::max(least, 1.01 * out.depth)) {
            const bool is_found = out.depth > least;
            if (++examined > most_cells || (is_found && ++since_found > cells_to_improve)) {
                out.proof = is_found ? SharedDepth::Proof::AtLeast : SharedDepth::Proof::Undecided;
                return out;
            }
            const Cell cell = cells.top();
            cells.pop();
            for (Cell& half : halves_of(cell)) add(std::move(half));
        }
        out.proof = out.depth > least ? SharedDepth::Proof::AtLeast : SharedDepth::Proof::Less;
        return out;
    }

private:
    static std::array<Cell, 2> halves_of(const Cell& cell)
    {
        int axis = 0;
        cell.half.maxCoeff(&axis);
        std::array<Cell, 2> out{cell, cell};
        for (const std::size_t k : {std::size_t(0), std::size_t(1)}) {
            out[k].half[axis] /= 2;
            out[k].middle[axis] += k == 0 ? -out[k].half[axis] : out[k].half[axis];
        }
        return out;
    }

    /// Sets the limit of a cell and its triangles. Returns how deep its middle is in both solids, m; at most 0 if the
    /// cell has no point that is deeper than `needed`.
    double examine(Cell& cell, double needed)
    {
        const double radius = cell.half.norm();
        std::array<double, 2> depths{};
        for (std::size_t s = 0; s < 2; ++s) {
            depths[s] = solids_[s]->shape ? depth_in(*solids_[s]->shape, cell.middle)
                                          : distance_to_surface(cell, s, radius);
            if (depths[s] + radius > needed) continue;
            cell.most = 0;
            return 0;
        }
        for (std::size_t s = 0; s < 2; ++s)
            if (!solids_[s]->shape && !is_inside(*solids_[s], cell.middle)) depths[s] = -depths[s];
        const double depth = std::min(depths[0], depths[1]);
        cell.most = std::min(reach_, depth + radius);
        return depth;
    }

    /// Returns the distance of a cell's middle from the nearest triangle, at most reach_, and drops the triangles that
    /// are not the nearest one to any point of the cell.
    double distance_to_surface(Cell& cell, std::size_t s, double radius)
    {
        const std::vector<std::array<Vec3, 3>>& triangles = solids_[s]->triangles;
        distances_.clear();
        double least = reach_;
        for (const std::uint32_t t : *cell.near[s]) {
            distances_.push_back(distance_to(triangles[t], cell.middle));
            least = std::min(least, distances_.back());
        }
        auto kept = std::make_shared<TriangleList>();
        for (std::size_t k = 0; k < distances_.size(); ++k)
            if (distances_[k] <= std::min(least, reach_) + 2 * radius) kept->push_back((*cell.near[s])[k]);
        if (kept->size() < cell.near[s]->size()) cell.near[s] = std::move(kept);
        return least;
    }

    bool is_inside(const Solid3& solid, const Vec3& point)
    {
        read_column(geometry_, point.x(), point.y(), column_);
        return std::any_of(column_.spans.begin(), column_.spans.end(), [&](const Span& span) {
            return span.part == solid.part && span.bottom < span.top && span.bottom <= point.z() &&
                   point.z() <= span.top;
        });
    }

    const Geometry& geometry_;
    const std::array<const Solid3*, 2> solids_;
    Cell root_;
    double reach_ = 0;  ///< m
    std::vector<double> distances_;
    Column column_;
};

}  // namespace

SharedDepth shared_depth(const Geometry& geometry, const Solid3& a, const Solid3& b, double least)
{
    if (a.shape && b.shape) return depth_of_primitives(*a.shape, *b.shape, least);
    return DepthSearch(geometry, a, b).search(least);
}

}  // namespace spawnfield
