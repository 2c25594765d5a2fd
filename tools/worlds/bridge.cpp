#include "bridge.h"

#include "things.h"

#include <algorithm>

using namespace spawnfield;

namespace worlds {
namespace {

// All lengths in m.
constexpr double ramp_length = 28, thickness = 0.6, foundation = 2, overlap = 0.5;
constexpr double post = 0.4, beam = 0.5, railing_height = 1.1, railing_width = 0.1, pillar = 1;
constexpr double half_length = bridge_length / 2, half_span = half_length - ramp_length;

hand::Mesh box_between(const Vec3& low, const Vec3& high)
{
    return hand::moved(hand::box(high - low), {(low + high) / 2, Mat3::Identity()});
}

hand::Mesh across(const std::vector<Eigen::Vector2d>& profile)
{
    return profile_along_y(profile, -bridge_half_width, bridge_half_width);
}

/// Returns a level slab between two wedges. The wedges overlap the slab a little, so that no gap opens when coordinates
/// are rounded in the file.
Pieces deck_of(const BridgeSite& site)
{
    const double foot = std::min({site.left_ground, site.right_ground, site.bed}) - foundation,
                 inner = half_span - overlap;
    return {
        box_between({-half_span, -bridge_half_width, site.deck - thickness}, {half_span, bridge_half_width, site.deck}),
        across({{-half_length, foot},
                {-inner, foot},
                {-inner, site.deck},
                {-half_span, site.deck},
                {-half_length, site.left_ground}}),
        across({{inner, foot},
                {half_length, foot},
                {half_length, site.right_ground},
                {half_span, site.deck},
                {inner, site.deck}})};
}

/// Returns two posts beside the path and a beam over it.
Pieces frame_at(double x, double deck)
{
    const double outer = bridge_half_width, inner = bridge_half_width - post, under_beam = deck + frame_top - beam;
    return {box_between({x - post / 2, -outer, deck - 0.1}, {x + post / 2, -inner, under_beam}),
            box_between({x - post / 2, inner, deck - 0.1}, {x + post / 2, outer, under_beam}),
            box_between({x - post / 2, -outer, under_beam}, {x + post / 2, outer, deck + frame_top})};
}

Pieces pillars_at(double x, const BridgeSite& site)
{
    Pieces out;
    const double foot = site.bed - foundation, top = site.deck - thickness / 2, half = pillar / 2;
    for (const double y : {-2.0, 2.0})
        out.push_back(box_between({x - half, y - half, foot}, {x + half, y + half, top}));
    return out;
}

Pieces railings(double deck)
{
    Pieces out;
    for (const double y : {-bridge_half_width, bridge_half_width - railing_width})
        out.push_back(box_between({-half_span, y, deck - 0.1}, {half_span, y + railing_width, deck + railing_height}));
    return out;
}

}  // namespace

void add_bridge(Scene& scene, const BridgeSite& site, Bridge bridge)
{
    Pieces deck = deck_of(site);
    std::vector<std::pair<const char*, Pieces>> others = {{"bridge-railings", railings(site.deck)}};
    for (const double x : {-18.0, -9.0, 0.0, 9.0, 18.0}) others.emplace_back("bridge-frame", frame_at(x, site.deck));
    for (const double x : {-13.5, -4.5, 4.5, 13.5}) others.emplace_back("bridge-pillars", pillars_at(x, site));
    if (bridge == Bridge::OneObject)
        for (const auto& [name, pieces] : others) deck.insert(deck.end(), pieces.begin(), pieces.end());
    add_thing(scene, "bridge", Label::Terrain, deck, site.world_from_bridge);
    if (bridge == Bridge::OneObject) return;
    for (const auto& [name, pieces] : others) add_thing(scene, name, Label::Obstacle, pieces, site.world_from_bridge);
}

}  // namespace worlds
