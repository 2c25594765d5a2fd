#pragma once

#include "model/collision_geometry.h"

#include <spawnfield/scene.h>

#include <optional>

namespace spawnfield {

/// Whether the glob matches one of the body's names, or all of them as scoped_name joins them.
bool matches_body(const std::string& glob, const CollisionBody& body);

/// Returns that of ground, floor, road, … with which a word of the name begins (words_of_name); "" if none does, or
/// if one begins with wall, ceiling, lamp, … .
std::string ground_word(const std::string& name);

/// The rules that label the collisions of an SDF or URDF world where the user does not: planes, heightmaps and what
/// is named as ground are terrain, all else is an obstacle. Of the body's names the innermost that says something
/// decides: in a model "ground_floor" the collision "wall" is an obstacle. Counts what each rule decides.
class GroundRules {
public:
    /// `by_slope`: for the words of the last rule.
    explicit GroundRules(bool by_slope);

    /// Nothing if no rule but the last, "all else", applies: an obstacle, if nobody knows better.
    std::optional<Label> label_of(const CollisionBody& body);

    /// Whether a rule found ground, or there was nothing in which it could have found some.
    bool has_ground() const;

    std::vector<NameRule> take() { return std::move(rules_); }

private:
    std::vector<NameRule> rules_;
};

}  // namespace spawnfield
