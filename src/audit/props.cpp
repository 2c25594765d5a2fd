#include "audit/props.h"

#include <algorithm>
#include <map>
#include <tuple>

namespace spawnfield {

Props::Props(const Geometry& geometry, const std::vector<std::string>& allow)
{
    const std::vector<Part>& parts = geometry.parts();
    is_allowed.resize(parts.size());
    is_ground.resize(parts.size());
    for (const std::string& glob : allow)
        for (const std::size_t part : parts_that_match(geometry, glob)) is_allowed[part] = true;
    std::map<std::string, std::uint32_t> numbers;
    for (std::size_t part = 0; part < parts.size(); ++part) {
        const std::string name = parts[part].name.substr(0, parts[part].name.find("::"));
        const auto [entry, is_new] = numbers.try_emplace(name, std::uint32_t(all.size()));
        if (is_new) all.push_back({.name = name});
        of.push_back(entry->second);
        if (is_allowed[part]) all[entry->second].is_allowed = true;
    }
    std::vector<std::uint64_t> orders;
    geometry.impl().for_each_tree([&](const Forest& forest, std::size_t t) {
        for (std::size_t number = 0; number < forest.trees[t].boxes().size(); ++number) {
            const Tile tile = geometry.impl().open(forest, t, number);
            for_each_bit(tile.alive, [&](std::uint32_t element) {
                const std::uint32_t part = tile.part(element);
                Prop& prop = all[of[part]];
                if (tile.label(element) != Label::Obstacle) {
                    is_ground[part] = true;
                    prop.is_ground = true;
                    return;
                }
                const Bounds box = tile.bounds(element);
                prop.bounds.extend(box.min);
                prop.bounds.extend(box.max);
                elements.push_back({&forest, std::uint32_t(t), std::uint32_t(number), element, of[part], box.min.z()});
                orders.push_back(tile.order(element));
            });
        }
    });
    std::vector<std::pair<std::uint64_t, PropElement>> sorted;
    for (std::size_t i = 0; i < elements.size(); ++i)
        if (!all[elements[i].prop].is_ground) sorted.emplace_back(orders[i], elements[i]);
    std::sort(sorted.begin(), sorted.end(), [](const auto& a, const auto& b) {
        return std::tie(a.second.bottom, a.first) < std::tie(b.second.bottom, b.first);
    });
    elements.clear();
    for (const auto& [order, element] : sorted) elements.push_back(element);
}

std::size_t Props::examined() const
{
    return std::size_t(std::count_if(all.begin(), all.end(), [](const Prop& prop) { return prop.is_examined(); }));
}

}  // namespace spawnfield
