#pragma once

#include <spawnfield/judge.h>

#include <optional>
#include <vector>

namespace spawnfield {

/// Returns an obstacle on which a robot rests, if there is one.
inline std::optional<CollisionHit> obstacle_below(const std::vector<RestContact>& contacts)
{
    for (const RestContact& contact : contacts)
        if (contact.label != Label::Terrain) return CollisionHit{contact.ground};
    return std::nullopt;
}

}  // namespace spawnfield
