#pragma once

#include "compounds.h"
#include "valley_land.h"

#include <spawnfield/scene.h>

#include <map>

namespace worlds {

/// Puts things on a land and remembers which ground is taken.
class Placer {
public:
    Placer(const ValleyLand& land, spawnfield::Scene& scene) : land_(land), scene_(scene) {}

    const ValleyLand& land() const { return land_; }
    spawnfield::Vec3 on_ground(const Vec2& p) const { return {p.x(), p.y(), land_.height(p)}; }

    /// Adds obstacles that are named kind-number-element. The number counts the things of this kind from 0.
    void add(const std::string& kind, const Compound& compound, const spawnfield::Pose& pose);
    void add(const std::string& kind, const Compound& compound, const Vec2& place, double yaw);

    void keep_clear(const Disc& ground) { taken_.push_back(ground); }
    void keep_clear(const Vec2& from, const Vec2& to,
                    double half_width);       ///< keeps a straight path clear; half_width in m
    bool is_clear(const Disc& ground) const;  ///< whether it overlaps nothing that is taken

private:
    struct Way {
        Vec2 from, to;
        double half_width;  ///< m
    };

    const ValleyLand& land_;
    spawnfield::Scene& scene_;
    std::vector<Disc> taken_;
    std::vector<Way> ways_;
    std::map<std::string, int> counts_;
};

}  // namespace worlds
