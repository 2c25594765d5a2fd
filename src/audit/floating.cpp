#include "audit/props.h"
#include "column/columns.h"
#include "reach/disjoint_sets.h"
#include "settle/convex_distance.h"
#include "settle/element_body.h"

#include <algorithm>
#include <map>
#include <set>

namespace spawnfield {
namespace {

/// Which props touch each other. Number 0 is the ground; the others are 1 + the number of a prop.
class Contacts {
public:
    Contacts(const Geometry& geometry, const Props& props, double gap)
        : geometry_(geometry), props_(props), gap_(gap + touch_tolerance)
    {
        sets_.grow(props.all.size() + 1);
        for (std::uint32_t p = 0; p < props.all.size(); ++p)
            if (props.all[p].is_ground) sets_.join(0, p + 1);
    }

    void join_near()
    {
        for (const PropElement& element : props_.elements)
            if (!is_held(element.prop)) join_near(element);
    }

    /// Joins props with the solids that they are inside of.
    void join_inside()
    {
        Column column;
        for (const PropElement& element : props_.elements) {
            if (is_held(element.prop)) continue;
            const Tile tile = open(element);
            const Vec3 point = middle_of(tile, element.element);
            read_column(geometry_, point.x(), point.y(), column);
            for (const Span& span : column.spans)
                if (span.bottom < point.z() && point.z() < span.top) sets_.join(element.prop + 1, of_part(span.part));
        }
    }

    bool is_held(std::uint32_t prop) { return sets_.find(prop + 1) == 0; }
    /// Returns the same number for props that touch.
    std::uint32_t group_of(std::uint32_t prop) { return sets_.find(prop + 1); }

    Tile open(const PropElement& at) const { return geometry_.impl().open(*at.forest, at.tree, at.tile); }

private:
    std::uint32_t of_part(std::uint32_t part) const { return props_.of[part] + 1; }

    static Vec3 middle_of(const Tile& tile, std::uint32_t element)
    {
        if (!tile.is_triangle(element)) return tile.primitive(element).shape().pose.position;
        const auto [a, b, c] = tile.corners(element);
        return (a + b + c) / 3;
    }

    void join_near(const PropElement& at)
    {
        const Tile tile = open(at);
        Bounds space = tile.bounds(at.element);
        const Vec3 origin = (space.min + space.max) / 2;
        const Convex body = body_of(tile, at.element, origin);
        space.min.array() -= gap_;
        space.max.array() += gap_;
        geometry_.impl().visit_tiles(space, [&](const Tile& near, const ElementBox&) {
            for_each_bit(near.near(space), [&](std::uint32_t other) {
                const std::uint32_t set = of_part(near.part(other));
                if (sets_.are_joined(set, at.prop + 1) || !near.bounds(other).meets(space)) return;
                if (shortest_way(body, body_of(near, other, origin)).norm() <= gap_) sets_.join(set, at.prop + 1);
            });
        });
    }

    const Geometry& geometry_;
    const Props& props_;
    const double gap_;
    DisjointSets sets_;
};

/// Returns the lowest point of an element, m.
Vec3 lowest_of(const Tile& tile, std::uint32_t element)
{
    const Bounds box = tile.bounds(element);
    const Vec3 origin = (box.min + box.max) / 2;
    return body_of(tile, element, origin).support(-Vec3::UnitZ()) + origin;
}

/// Sets what is below the lowest point of a group.
void look_below(FloatingProps& floating, const Geometry& geometry, const Props& props, Contacts& contacts,
                std::uint32_t group)
{
    const Column column = column_at(geometry, floating.lowest.x(), floating.lowest.y());
    for (const Span& span : column.spans) {
        if (span.top > floating.lowest.z() || contacts.group_of(props.of[span.part]) == group) continue;
        floating.height = floating.lowest.z() - span.top;
        floating.below = geometry.parts()[span.part].name;
        return;
    }
}

}  // namespace

std::vector<FloatingProps> find_floating(const Geometry& geometry, const Props& props, double gap,
                                         const std::vector<SunkenProp>& sunken)
{
    Contacts contacts(geometry, props, gap);
    contacts.join_near();
    contacts.join_inside();
    std::set<std::string> is_sunken;
    for (const SunkenProp& prop : sunken) is_sunken.insert(prop.prop);
    std::map<std::uint32_t, std::size_t> places;  // of groups, in `out`
    std::vector<FloatingProps> out;
    const auto is_listed = [&](std::uint32_t p) {
        const Prop& prop = props.all[p];
        return prop.is_examined() && !contacts.is_held(p) && !is_sunken.contains(prop.name);
    };
    for (std::uint32_t p = 0; p < props.all.size(); ++p) {
        if (!is_listed(p)) continue;
        const auto [place, is_new] = places.try_emplace(contacts.group_of(p), out.size());
        if (is_new) out.emplace_back();
        out[place->second].props.push_back(props.all[p].name);
    }
    std::set<std::uint32_t> found;
    for (const PropElement& element : props.elements) {  // the lowest first
        if (!is_listed(element.prop)) continue;
        const std::uint32_t group = contacts.group_of(element.prop);
        if (!found.insert(group).second) continue;
        FloatingProps& floating = out[places.at(group)];
        floating.lowest = lowest_of(contacts.open(element), element.element);
        look_below(floating, geometry, props, contacts, group);
    }
    return out;
}

}  // namespace spawnfield
