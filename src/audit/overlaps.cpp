#include "audit/props.h"
#include "audit/solid_depth.h"
#include "base/parallel.h"

#include <algorithm>
#include <map>
#include <tuple>

namespace spawnfield {
namespace {

/// Returns whether a part may be in an overlap.
bool is_compared(const Props& props, std::uint32_t part) { return !props.is_ground[part] && !props.is_allowed[part]; }

/// Calls visit(tile, element) for each element of obstacles.
template <class Visit>
void for_each_obstacle(const Geometry& geometry, const Visit& visit)
{
    geometry.impl().for_each_tree([&](const Forest& forest, std::size_t t) {
        for (std::size_t number = 0; number < forest.trees[t].boxes().size(); ++number) {
            const Tile tile = geometry.impl().open(forest, t, number);
            for_each_bit(tile.alive, [&](std::uint32_t element) {
                if (tile.label(element) == Label::Obstacle) visit(tile, element);
            });
        }
    });
}

bool is_filled(const Tile& tile, std::uint32_t triangle) { return tile.piece(triangle).solid != 0; }

/// Returns the solids of all parts that are compared. The triangles of meshes are still missing.
std::vector<Solid3> solids_of(const Geometry& geometry, const Props& props)
{
    std::vector<std::pair<std::uint64_t, Solid3>> found;
    std::map<std::uint32_t, Solid3> meshes;  // of each part
    for_each_obstacle(geometry, [&](const Tile& tile, std::uint32_t element) {
        const std::uint32_t part = tile.part(element);
        if (!is_compared(props, part)) return;
        if (!tile.is_triangle(element)) {
            const Shape shape = tile.primitive(element).shape();
            found.emplace_back(tile.order(element), Solid3{part, bounds_of(shape), shape, {}});
        } else if (is_filled(tile, element)) {
            Solid3& mesh = meshes.try_emplace(part, Solid3{part, {}, {}, {}}).first->second;
            for (const Vec3& corner : tile.corners(element)) mesh.bounds.extend(corner);
        }
    });
    std::sort(found.begin(), found.end(), [](const auto& a, const auto& b) { return a.first < b.first; });
    std::vector<Solid3> out;
    for (auto& [order, solid] : found) out.push_back(std::move(solid));
    for (auto& [part, mesh] : meshes) out.push_back(std::move(mesh));
    std::stable_sort(out.begin(), out.end(), [](const Solid3& a, const Solid3& b) { return a.part < b.part; });
    return out;
}

/// Returns whether boxes overlap by more than `least` along all axes.
bool boxes_overlap(const Bounds& a, const Bounds& b, double least)
{
    return ((a.max.cwiseMin(b.max) - a.min.cwiseMax(b.min)).array() > least).all();
}

using Pair = std::array<std::uint32_t, 2>;

/// Returns the pairs of solids whose bounding boxes overlap by more than `least`, as indices, ascending. The boxes are
/// swept along x.
std::vector<Pair> near_pairs(const std::vector<Solid3>& solids, const Props& props, double least)
{
    std::vector<std::uint32_t> order(solids.size());
    for (std::uint32_t i = 0; i < order.size(); ++i) order[i] = i;
    std::sort(order.begin(), order.end(), [&](std::uint32_t i, std::uint32_t k) {
        return std::tuple(solids[i].bounds.min.x(), i) < std::tuple(solids[k].bounds.min.x(), k);
    });
    std::vector<Pair> out;
    for (std::size_t i = 0; i < order.size(); ++i) {
        const Solid3& a = solids[order[i]];
        for (std::size_t k = i + 1; k < order.size(); ++k) {
            const Solid3& b = solids[order[k]];
            if (!(b.bounds.min.x() < a.bounds.max.x() - least)) break;
            if (props.of[a.part] != props.of[b.part] && boxes_overlap(a.bounds, b.bounds, least))
                out.push_back({std::min(order[i], order[k]), std::max(order[i], order[k])});
        }
    }
    std::sort(out.begin(), out.end());
    return out;
}

/// Reads the triangles of the meshes that are in a pair.
void read_triangles(std::vector<Solid3>& solids, const std::vector<Pair>& pairs, const Geometry& geometry)
{
    std::map<std::uint32_t, Solid3*> meshes;
    for (const Pair& pair : pairs)
        for (const std::uint32_t i : pair)
            if (!solids[i].shape) meshes[solids[i].part] = &solids[i];
    if (meshes.empty()) return;
    std::map<std::uint32_t, std::vector<std::pair<std::uint64_t, std::array<Vec3, 3>>>> found;
    for_each_obstacle(geometry, [&](const Tile& tile, std::uint32_t element) {
        if (tile.is_triangle(element) && is_filled(tile, element) && meshes.contains(tile.part(element)))
            found[tile.part(element)].emplace_back(tile.order(element), tile.corners(element));
    });
    for (auto& [part, triangles] : found) {
        std::sort(triangles.begin(), triangles.end(), [](const auto& a, const auto& b) { return a.first < b.first; });
        for (const auto& [order, corners] : triangles) meshes.at(part)->triangles.push_back(corners);
    }
}

}  // namespace

void find_overlaps(const Geometry& geometry, const Props& props, const PartLimits& limits, PartFindings& out)
{
    std::vector<Solid3> solids = solids_of(geometry, props);
    const std::vector<Pair> pairs = near_pairs(solids, props, limits.overlap);
    read_triangles(solids, pairs, geometry);
    std::vector<SharedDepth> depths(pairs.size());
    parallel_for(pairs.size(), limits.threads, limits.progress, [&](std::size_t i) {
        depths[i] = shared_depth(geometry, solids[pairs[i][0]], solids[pairs[i][1]], limits.overlap);
    });
    using Proof = SharedDepth::Proof;
    std::map<Pair, SharedDepth> deepest;  // of two parts
    for (std::size_t i = 0; i < pairs.size(); ++i) {
        SharedDepth& most = deepest[{solids[pairs[i][0]].part, solids[pairs[i][1]].part}];
        const auto rank = [](const SharedDepth& depth) {
            const int proof = depth.proof == Proof::Less ? 0 : depth.proof == Proof::Undecided ? 1 : 2;
            return std::tuple(proof, depth.depth);
        };
        if (rank(depths[i]) > rank(most)) most = depths[i];
    }
    for (const auto& [parts, depth] : deepest) {
        if (depth.proof == Proof::Less) continue;
        (depth.proof == Proof::Undecided ? out.undecided : out.overlaps)
            .push_back({geometry.parts()[parts[0]].name, geometry.parts()[parts[1]].name, depth.depth,
                        depth.proof == Proof::Exact, depth.place});
    }
}

}  // namespace spawnfield
