#include "scene/ground_rules.h"

#include "scene/glob.h"

#include <algorithm>
#include <cctype>
#include <optional>

namespace spawnfield {
namespace {

using Kind = CollisionGeometry::Kind;

/// What stands for ground in most worlds; a name matches from the start of one of its words on.
constexpr std::array ground_names{"ground*", "terrain*", "floor*", "road*", "street*", "sidewalk*", "pavement*", "asphalt*", "bridge*", "ramp*"};

/// What stands on or beside such ground, in a name that begins like it: from the start of a word on, or of a hump ("bridgeRailing").
constexpr std::array furniture_names{"light*", "lamp*", "sign*", "block*", "barrier*", "rail*", "cone*", "post*", "pole*",
                                     "roadblock*", "roadsign*", "streetlight*", "streetlamp*", "floorlamp*", "rampart*"};

/// Between "e" and "R" of "bridgeRailing".
bool is_hump(unsigned char before, unsigned char after) { return std::islower(before) && std::isupper(after); }

/// Whether the glob matches the name from a word's start: "GroundB_01" in "warehouse_GroundB_01".
bool matches_from_a_word(const std::string& glob, const std::string& name, bool from_humps = false)
{
    for (std::size_t start = 0; start < name.size(); ++start) {
        const bool is_start = start == 0 || !std::isalnum(static_cast<unsigned char>(name[start - 1])) ||
                              (from_humps && is_hump(static_cast<unsigned char>(name[start - 1]), static_cast<unsigned char>(name[start])));
        if (is_start && matches(glob, name.substr(start))) return true;
    }
    return false;
}

bool is_furniture(const std::string& name)
{
    return std::any_of(furniture_names.begin(), furniture_names.end(), [&](const char* glob) { return matches_from_a_word(glob, name, true); });
}

/// By number of ground_names; nothing if no name of the body is one of ground.
struct GroundName {
    std::optional<std::size_t> ground;
    bool has_furniture = false;  ///< a name that would be one of ground is one of furniture
};

GroundName ground_name_of(const CollisionBody& body)
{
    GroundName out;
    for (std::size_t r = 0; r < ground_names.size(); ++r)
        for (const std::string& name : body.names) {
            if (!matches_from_a_word(ground_names[r], name)) continue;
            if (is_furniture(name)) out.has_furniture = true;
            else if (!out.ground) out.ground = r;
        }
    return out;
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
    rules_.push_back({"name of these with light, lamp, sign, block, barrier, rail, cone, post or pole", Label::Obstacle, 0});
    rules_.push_back({"all else", Label::Obstacle, 0});
}

Label GroundRules::label_of(const CollisionBody& body)
{
    const GroundName name = ground_name_of(body);
    const std::size_t rule = body.geometry.kind == Kind::Plane       ? 0
                             : body.geometry.kind == Kind::Heightmap ? 1
                             : name.ground                           ? 2 + *name.ground
                                                                     : rules_.size() - (name.has_furniture ? 2 : 1);
    ++rules_[rule].count;
    return rules_[rule].label;
}

bool GroundRules::has_ground() const
{
    const auto is_used = [](const NameRule& rule) { return rule.count > 0; };
    const auto is_obstacle = [](const NameRule& rule) { return rule.label == Label::Obstacle; };
    const auto obstacles = std::find_if(rules_.begin(), rules_.end(), is_obstacle);
    return std::any_of(rules_.begin(), obstacles, is_used) || std::none_of(obstacles, rules_.end(), is_used);
}

}  // namespace spawnfield
