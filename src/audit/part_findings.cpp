#include "audit/props.h"

#include <spawnfield/error.h>

#include <cmath>

namespace spawnfield {
namespace {

void check(const PartLimits& limits)
{
    if (!(limits.gap >= 0 && std::isfinite(limits.gap)))
        throw ArgumentError("find_wrong_parts", "gap", limits.gap, ">= 0 m");
    if (!(limits.overlap > 0 && std::isfinite(limits.overlap)))
        throw ArgumentError("find_wrong_parts", "overlap", limits.overlap, "> 0 m");
}

}  // namespace

PartFindings find_wrong_parts(const Map& map, const PartLimits& limits)
{
    check(limits);
    const Props props(map.geometry, limits.allow);
    PartFindings out{.props = props.examined()};
    out.sunken = find_sunken(map.geometry, props, limits.threads);
    out.floating = find_floating(map.geometry, props, limits.gap, out.sunken);
    find_overlaps(map.geometry, props, limits, out);
    return out;
}

}  // namespace spawnfield
