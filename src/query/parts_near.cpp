#include "query/parts_near.h"

#include "geometry/geometry_impl.h"
#include "settle/convex_distance.h"
#include "settle/element_body.h"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace spawnfield {
namespace {

Bounds bounds_of_box(const ElementBox& box)
{
    return {Vec3(box.min[0], box.min[1], box.min[2]), Vec3(box.max[0], box.max[1], box.max[2])};
}

/// Returns a lower limit of the distance between what the boxes contain, m.
double distance_between(const Bounds& a, const Bounds& b)
{
    return (a.min - b.max).cwiseMax(b.min - a.max).cwiseMax(0).norm();
}

}  // namespace

std::vector<PartsNear::Element> PartsNear::elements_of(const Geometry& geometry, const Selection& parts)
{
    std::vector<Element> found;
    std::vector<ElementBox> boxes;
    const Geometry::Impl& impl = geometry.impl();
    impl.for_each_tree([&](const Forest& forest, std::size_t tree) {
        for (std::size_t number = 0; number < forest.trees[tree].boxes().size(); ++number) {
            const Tile tile = impl.open(forest, tree, number);
            for (std::uint32_t k = 0; k < tile.elements(); ++k) {
                if (!parts.contains(tile.part(k), tile.group(k))) continue;
                found.push_back({&forest, std::uint32_t(tree), std::uint32_t(number), k, tile.box(k)});
                boxes.push_back(found.back().box);
            }
        }
    });
    std::vector<std::uint32_t> order(found.size());
    std::iota(order.begin(), order.end(), 0u);
    std::vector<Element> out;
    for (const std::uint32_t i : packed_order(boxes, std::move(order), 1)) out.push_back(found[i]);
    return out;
}

std::vector<ElementBox> PartsNear::boxes_of(const std::vector<Element>& elements)
{
    std::vector<ElementBox> out;
    for (const Element& element : elements) out.push_back(element.box);
    return out;
}

PartsNear::PartsNear(const Geometry& geometry, const Selection& parts)
    : geometry_(geometry), elements_(elements_of(geometry, parts)), tree_(boxes_of(elements_))
{
    for (const Element& element : elements_) {
        const Bounds box = bounds_of_box(element.box);
        bounds_.extend(box.min);
        bounds_.extend(box.max);
    }
}

std::optional<Vec3> PartsNear::way_from(const std::vector<Convex>& bodies, const Vec3& position, double most) const
{
    if (elements_.empty()) return std::nullopt;
    std::vector<Bounds> boxes;
    Bounds all;
    for (const Convex& body : bodies) {
        boxes.push_back(body.bounds());
        all.extend(boxes.back().min);
        all.extend(boxes.back().max);
    }
    std::optional<Vec3> out;
    double least = std::nextafter(most, std::numeric_limits<double>::infinity());
    const auto measure = [&](std::size_t number) {
        const Element& element = elements_[number];
        Bounds box = bounds_of_box(element.box);
        box.min -= position;
        box.max -= position;
        if (!(distance_between(all, box) < least)) return;
        const Tile tile = geometry_.impl().open(*element.forest, element.tree, element.tile);
        const Convex solid = body_of(tile, element.element, position);
        for (std::size_t k = 0; k < bodies.size(); ++k) {
            if (!(distance_between(boxes[k], box) < least)) continue;
            const Vec3 way = shortest_way(bodies[k], solid);
            if (!(way.norm() < least)) continue;
            least = way.norm();
            out = way;
        }
    };
    // Looks near the bodies first: if something is there, what is farther away need not be looked at.
    const Bounds here{all.min + position, all.max + position};
    const double farthest = std::min(most, (bounds_.max - here.min).cwiseMax(here.max - bounds_.min).maxCoeff());
    for (double reach = std::max(distance_between(here, bounds_), 0.5);; reach *= 2) {
        const Vec3 by = Vec3::Constant(std::min(reach, farthest));
        tree_.visit(Bounds{here.min - by, here.max + by}, measure);
        if (least <= reach || reach >= farthest) return out;
    }
}

}  // namespace spawnfield
