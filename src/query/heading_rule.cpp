#include <spawnfield/heading_rule.h>

#include "base/number.h"

namespace spawnfield {

std::string to_string(const HeadingRule& rule)
{
    const auto several = [&](const char* name) { return name + std::to_string(rule.count); };
    switch (rule.kind) {
    case HeadingRule::Kind::Facing: return "facing:" + number(rule.x) + "," + number(rule.y);
    case HeadingRule::Kind::Downhill: return "downhill";
    case HeadingRule::Kind::Uphill: return "uphill";
    case HeadingRule::Kind::All: return several("all:");
    case HeadingRule::Kind::Any: return several("any:");
    case HeadingRule::Kind::Best: return several("best:");
    case HeadingRule::Kind::Clearest: return several("best:") + ":clearance";
    case HeadingRule::Kind::Along: return several("along:");
    }
    return "";
}

std::string yaw_text(const std::optional<HeadingRule>& rule, bool is_random, double yaw)
{
    if (rule) return to_string(*rule);
    return is_random ? "random" : number(yaw);
}

}  // namespace spawnfield
