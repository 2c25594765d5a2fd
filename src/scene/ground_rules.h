#pragma once

#include "scene/collision_geometry.h"

namespace spawnfield {

/// Whether the glob matches one of the body's names, or all of them as scoped_name joins them.
bool matches_body(const std::string& glob, const CollisionBody& body);

/// By which the collisions of an SDF or URDF world are labelled where the user says nothing: planes, heightmaps and what is
/// named as ground are terrain, but for names such as street_light and floor_lamp; all else is an obstacle. Counts what each
/// rule decides.
class GroundRules {
public:
    GroundRules();

    Label label_of(const CollisionBody& body);

    /// Whether a rule found ground, or there was nothing in which it could have found some.
    bool has_ground() const;

    std::vector<NameRule> take() { return std::move(rules_); }

private:
    std::vector<NameRule> rules_;
};

}  // namespace spawnfield
