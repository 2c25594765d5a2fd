#include "complex_landmarks.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <stdexcept>

using namespace spawnfield;

namespace worlds {
namespace {

/// Returns the bounds of each part: around its triangles, and around the middles and upper ends of its primitives.
std::vector<Bounds> bounds_of_parts(const Scene& scene)
{
    std::vector<Bounds> bounds(scene.parts.size());
    for (std::size_t t = 0; t < scene.triangles.size(); ++t)
        for (const std::uint32_t v : scene.triangles[t])
            bounds[scene.pieces[scene.triangle_pieces[t]].part].extend(scene.vertices[v]);
    for (const Primitive& primitive : scene.primitives) {
        const Shape& shape = primitive.shape;
        const double length = shape.kind == ShapeKind::Box ? shape.size[2] : shape.size[1];
        for (const double up : {0.0, length / 2}) bounds[primitive.part].extend(shape.pose.position + Vec3(0, 0, up));
    }
    return bounds;
}

class Guide {
public:
    Guide(const Scene& scene, const Island& island) : scene_(scene), island_(island), bounds_(bounds_of_parts(scene)) {}

    Landmark car() const;
    Landmark fence_and_water() const;
    Landmark bridge() const
    {
        return {"bridge", around(StreetGrid::to_world({Island::canal_u, Island::bridge_v}), 40)};
    }
    Landmark houses() const;
    Landmark shore() const;

private:
    Bounds around(const Vec2& middle, double half) const;
    double wet_share(const Vec2& middle, double half) const;
    std::vector<Vec2> middles_of(const std::string& kind) const;

    const Scene& scene_;
    const Island& island_;
    const std::vector<Bounds> bounds_;
};

/// Returns a square on the ground that is as high as the highest thing in it. Coordinates are rounded to metres.
Bounds Guide::around(const Vec2& middle, double half) const
{
    const Vec2 low = (middle.array() - half).round(), high = (middle.array() + half).round();
    Bounds region = {{low.x(), low.y(), 0}, {high.x(), high.y(), 0}};
    double top = 0;
    for (double y = low.y(); y <= high.y(); y += 2)
        for (double x = low.x(); x <= high.x(); x += 2) top = std::max(top, island_.height({x, y}));
    for (std::size_t i = 0; i < bounds_.size(); ++i)
        if (scene_.parts[i].name.find('-') != std::string::npos && bounds_[i].meets(region, 2))
            top = std::max(top, bounds_[i].max.z());
    region.max.z() = std::ceil(top);
    return region;
}

/// Returns the share of 9 x 9 places in a square that lie under the sea.
double Guide::wet_share(const Vec2& middle, double half) const
{
    int wet = 0;
    for (int row = -4; row <= 4; ++row)
        for (int col = -4; col <= 4; ++col)
            wet += island_.height(middle + half / 4 * Vec2(col, row)) < Island::sea_level;
    return wet / 81.0;
}

std::vector<Vec2> Guide::middles_of(const std::string& kind) const
{
    std::vector<Vec2> middles;
    for (std::size_t i = 0; i < bounds_.size(); ++i)
        if (scene_.parts[i].name.starts_with(kind + "-"))
            middles.push_back((bounds_[i].min + bounds_[i].max).head<2>() / 2);
    return middles;
}

/// Returns the place with the smallest measure. Throws std::runtime_error if there are no places.
Vec2 best_of(const std::vector<Vec2>& places, const std::function<double(const Vec2&)>& measure)
{
    if (places.empty()) throw std::runtime_error("complex_district: no place for a landmark");
    std::vector<double> measures;
    for (const Vec2& place : places) measures.push_back(measure(place));
    return places[std::size_t(std::min_element(measures.begin(), measures.end()) - measures.begin())];
}

/// Returns the region around a car on dry ground near the middle of the island.
Landmark Guide::car() const
{
    const Vec2 place = best_of(
        middles_of("car"), [&](const Vec2& p) { return (p - StreetGrid::origin()).norm() + 1e4 * wet_share(p, 8); });
    return {"car", around(place, 8)};
}

/// Returns the region around a fence panel in a place that is half under water.
Landmark Guide::fence_and_water() const
{
    const Vec2 place = best_of(middles_of("fence"), [&](const Vec2& p) { return std::abs(wet_share(p, 12) - 0.5); });
    return {"fence_and_water", around(place, 12)};
}

/// Returns the dry region of 80 x 80 m with the most houses.
Landmark Guide::houses() const
{
    constexpr double half = 40;
    const std::vector<Vec2> middles = middles_of("house");
    const Vec2 place = best_of(middles, [&](const Vec2& p) {
        const auto is_near = [&](const Vec2& other) { return (other - p).cwiseAbs().maxCoeff() < half; };
        return 100 * wet_share(p, half) - double(std::count_if(middles.begin(), middles.end(), is_near));
    });
    return {"houses", around(place, half)};
}

/// Returns the region where dry ground begins, going east from the western edge of the sea.
Landmark Guide::shore() const
{
    Vec2 p(Island::low_x, StreetGrid::origin().y());
    while (!island_.has_ground(p) || island_.height(p) < Island::sea_level) p.x() += 1;
    return {"shore", around(p, 30)};
}

}  // namespace

std::vector<Landmark> complex_landmarks(const Scene& scene, const Island& island)
{
    const Guide guide(scene, island);
    return {guide.car(), guide.fence_and_water(), guide.bridge(), guide.houses(), guide.shore()};
}

}  // namespace worlds
