#include "scene/stray_parts.h"

#include "base/number.h"
#include "scene/elements.h"

#include <algorithm>
#include <array>

namespace spawnfield {
namespace {

struct PlacedBox {
    std::uint32_t part;
    Bounds box;
    double distance = 0;  ///< m, from the middle of all parts
};

/// Returns the boxes of all parts with elements, without infinite planes.
std::vector<PlacedBox> boxes_of(const Scene& scene)
{
    std::vector<Bounds> boxes(scene.parts.size());
    for (std::uint32_t e = 0; e < element_count(scene); ++e) {
        const Bounds box = element_bounds(scene, e);
        Bounds& all = boxes[element_part(scene, e)];
        all.extend(box.min);
        all.extend(box.max);
    }
    std::vector<PlacedBox> out;
    for (std::uint32_t p = 0; p < boxes.size(); ++p)
        if (!boxes[p].is_empty() && scene.parts[p].kind != "plane") out.push_back({p, boxes[p]});
    return out;
}

/// Returns the point whose coordinates are the medians of the boxes' centres: a few strays do not move it far.
Vec3 middle_of(const std::vector<PlacedBox>& boxes)
{
    Vec3 out;
    std::vector<double> values(boxes.size());
    for (int axis = 0; axis < 3; ++axis) {
        std::transform(boxes.begin(), boxes.end(), values.begin(),
                       [&](const PlacedBox& placed) { return (placed.box.min[axis] + placed.box.max[axis]) / 2; });
        const auto median = values.begin() + std::ptrdiff_t(values.size() / 2);
        std::nth_element(values.begin(), median, values.end());
        out[axis] = *median;
    }
    return out;
}

double gap_between(const Bounds& a, const Bounds& b)
{
    return (a.min - b.max).cwiseMax(b.min - a.max).cwiseMax(Vec3::Zero()).norm();
}

}  // namespace

std::vector<StrayPart> stray_parts(const Scene& scene)
{
    constexpr double usual_world = 20000, least_rest = 1;  // m
    constexpr double most_times = 100;
    std::vector<PlacedBox> boxes = boxes_of(scene);
    if (boxes.size() < 2) return {};
    const Vec3 middle = middle_of(boxes);
    for (PlacedBox& placed : boxes) placed.distance = gap_between(placed.box, {middle, middle});
    std::stable_sort(boxes.begin(), boxes.end(),
                     [](const PlacedBox& a, const PlacedBox& b) { return a.distance < b.distance; });
    std::vector<Bounds> rests{boxes[0].box};  // rests[k]: around the k + 1 boxes that are nearest to the middle
    for (std::size_t k = 1; k < boxes.size(); ++k) {
        rests.push_back(rests.back());
        rests.back().extend(boxes[k].box.min);
        rests.back().extend(boxes[k].box.max);
    }
    std::vector<StrayPart> out;
    for (std::size_t k = boxes.size() - 1; k > 0; --k) {
        const Bounds& rest = rests[k - 1];
        const double gap = gap_between(boxes[k].box, rest), size = (rest.max - rest.min).norm();
        if (gap <= usual_world && gap <= most_times * std::max(size, least_rest)) break;
        out.push_back({scene.parts[boxes[k].part].name, gap, size});
    }
    return out;
}

std::string words_for(const std::vector<StrayPart>& parts)
{
    const StrayPart& first = parts.front();
    const std::string more = parts.size() == 1 ? "" : " (and " + std::to_string(parts.size() - 1) + " more parts)";
    return "part \"" + first.name + "\" is " + rounded(first.distance) + " m away from the rest of the world" + more +
           ", which is " + rounded(parts.back().rest) +
           " m long; its position is most likely wrong. Correct it, leave it out (--label '" + first.name +
           "=ignore'), or limit the map with --bounds";
}

}  // namespace spawnfield
