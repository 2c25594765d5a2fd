#include "scene/ground_rules.h"

#include "scene/glob.h"
#include "scene/name_words.h"

#include <algorithm>

namespace spawnfield {
namespace {

using Kind = CollisionGeometry::Kind;

/// Words for the ground of most worlds. A word of a name counts if it begins with one of these.
constexpr std::array ground_words{"ground",   "terrain",  "floor",   "road",   "street",
                                  "sidewalk", "pavement", "asphalt", "bridge", "ramp"};

/// Words for things on, beside or above the ground, whose names may contain a ground word: "street_light",
/// "Floor_01_ceiling", "bridgeRailing". Again a word counts if it begins with one of these ("staircase", "doorway").
constexpr std::array other_words{"ceiling",    "wall",      "roof",   "door",      "window",   "stair",
                                 "lamp",       "light",     "sign",   "block",     "barrier",  "rail",
                                 "cone",       "post",      "pole",   "roadblock", "roadsign", "streetlight",
                                 "streetlamp", "floorlamp", "rampart"};

constexpr const char* other_rule =
    "name of ground that also has ceiling, wall, roof, door, window, stair, lamp, light, sign, block, barrier, rail, "
    "cone, post or pole";

/// The known words that a name contains.
struct NameWords {
    std::optional<std::size_t> ground;  ///< index into ground_words
    bool is_other = false;              ///< a word begins with one of other_words; then it is not ground
};

NameWords find_words(const std::string& name)
{
    NameWords out;
    for (const std::string& word : words_of_name(name)) {
        const auto begins = [&](const char* stem) { return word.starts_with(stem); };
        out.is_other = out.is_other || std::any_of(other_words.begin(), other_words.end(), begins);
        const auto ground = std::find_if(ground_words.begin(), ground_words.end(), begins);
        if (!out.ground && ground != ground_words.end()) out.ground = std::size_t(ground - ground_words.begin());
    }
    return out;
}

/// Decides by the innermost name that contains a ground word or another word. If both `ground` and `is_other` are set,
/// a name contains a ground word, but another word overrules it.
NameWords find_words(const CollisionBody& body)
{
    NameWords out;
    bool is_decided = false;
    for (auto name = body.names.rbegin(); name != body.names.rend(); ++name) {
        const NameWords found = find_words(*name);
        if (!out.ground) out.ground = found.ground;
        if (!is_decided) out.is_other = found.is_other;
        is_decided = is_decided || found.ground || found.is_other;
    }
    return out;
}

}  // namespace

bool matches_body(const std::string& glob, const CollisionBody& body)
{
    return matches(glob, scoped_name(body)) ||
           std::any_of(body.names.begin(), body.names.end(),
                       [&](const std::string& name) { return matches(glob, name); });
}

std::string ground_word(const std::string& name)
{
    const NameWords found = find_words(name);
    return found.ground && !found.is_other ? ground_words[*found.ground] : "";
}

GroundRules::GroundRules(bool by_slope)
{
    rules_.push_back({"plane", Label::Terrain, 0});
    rules_.push_back({"heightmap", Label::Terrain, 0});
    for (const char* const word : ground_words)
        rules_.push_back({std::string("name ") + word + "*", Label::Terrain, 0});
    rules_.push_back({other_rule, Label::Obstacle, 0});
    rules_.push_back({by_slope ? "all else, except what --auto-label makes terrain," : "all else", Label::Obstacle, 0});
}

std::optional<Label> GroundRules::label_of(const CollisionBody& body)
{
    const NameWords found = find_words(body);
    const std::size_t all_else = rules_.size() - 1, other = all_else - 1;
    const std::size_t rule = body.geometry.kind == Kind::Plane       ? 0
                             : body.geometry.kind == Kind::Heightmap ? 1
                             : found.ground && !found.is_other       ? 2 + *found.ground
                             : found.ground                          ? other
                                                                     : all_else;
    ++rules_[rule].count;
    return rule == all_else ? std::nullopt : std::optional(rules_[rule].label);
}

bool GroundRules::has_ground() const
{
    const auto is_used = [](const NameRule& rule) { return rule.count > 0; };
    const auto is_obstacle = [](const NameRule& rule) { return rule.label == Label::Obstacle; };
    const auto obstacles = std::find_if(rules_.begin(), rules_.end(), is_obstacle);
    return std::any_of(rules_.begin(), obstacles, is_used) || std::none_of(obstacles, rules_.end(), is_used);
}

}  // namespace spawnfield
