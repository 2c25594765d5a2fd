#include "scene/ground_rules.h"

#include <algorithm>
#include <cctype>

namespace spawnfield {
namespace {

using Kind = CollisionGeometry::Kind;

/// What stands for ground in most worlds; a name matches from the start of one of its words on.
constexpr std::array ground_names{"ground*", "terrain*", "floor*", "road*", "street*", "sidewalk*", "pavement*", "asphalt*", "bridge*", "ramp*"};

/// Whether the glob matches the name from a word's start: "GroundB_01" in "warehouse_GroundB_01".
bool matches_from_a_word(const std::string& glob, const std::string& name)
{
    for (std::size_t start = 0; start < name.size(); ++start) {
        const bool is_start = start == 0 || !std::isalnum(static_cast<unsigned char>(name[start - 1]));
        if (is_start && matches(glob, name.substr(start))) return true;
    }
    return false;
}

}  // namespace

bool matches_body(const std::string& glob, const CollisionBody& body)
{
    return matches(glob, scoped_name(body)) ||
           std::any_of(body.names.begin(), body.names.end(), [&](const std::string& name) { return matches(glob, name); });
}

GroundRules::GroundRules()
{
    rules_.push_back({"plane", Label::Terrain, 0});
    rules_.push_back({"heightmap", Label::Terrain, 0});
    for (const char* const name : ground_names) rules_.push_back({std::string("name ") + name, Label::Terrain, 0});
    rules_.push_back({"all else", Label::Obstacle, 0});
}

Label GroundRules::label_of(const CollisionBody& body)
{
    std::size_t rule = 0;
    while (!holds(rule, body)) ++rule;
    ++rules_[rule].count;
    return rules_[rule].label;
}

bool GroundRules::has_ground() const
{
    return rules_.back().count == 0 || std::any_of(rules_.begin(), rules_.end() - 1, [](const NameRule& rule) { return rule.count > 0; });
}

bool GroundRules::holds(std::size_t rule, const CollisionBody& body) const
{
    if (rule == 0) return body.geometry.kind == Kind::Plane;
    if (rule == 1) return body.geometry.kind == Kind::Heightmap;
    if (rule + 1 == rules_.size()) return true;
    return std::any_of(body.names.begin(), body.names.end(), [&](const std::string& name) { return matches_from_a_word(ground_names[rule - 2], name); });
}

}  // namespace spawnfield
