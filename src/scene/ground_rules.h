#pragma once

#include "model/collision_geometry.h"

#include <spawnfield/scene.h>

#include <optional>

namespace spawnfield {

/// Returns whether the glob matches one of the body's names, or its scoped name.
bool matches_body(const std::string& glob, const CollisionBody& body);

/// Returns the first of ground, floor, road, … with which a word of the name begins (words_of_name). Returns "" if
/// there is none, or if a word begins with wall, ceiling, lamp, … .
std::string ground_word(const std::string& name);

/// The rules that label the collisions of an SDF or URDF world if the user's rules do not: planes, heightmaps and names
/// of ground are terrain, all else is obstacle. Among the body's names, the innermost that contains a ground word or
/// another known word decides: in the model "ground_floor" the collision "wall" is an obstacle. Each rule counts the
/// bodies that it decides.
class GroundRules {
public:
    /// `by_slope`: whether --auto-label is given. It changes only the text of the last rule.
    explicit GroundRules(bool by_slope);

    /// Returns the label; empty if only the last rule, "all else", applies. Then the body is an obstacle unless its
    /// slope decides.
    std::optional<Label> label_of(const CollisionBody& body);

    /// Returns whether a rule found ground, or there was no body to decide.
    bool has_ground() const;

    std::vector<NameRule> take() { return std::move(rules_); }

private:
    std::vector<NameRule> rules_;
};

}  // namespace spawnfield
