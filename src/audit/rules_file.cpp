#include "base/number.h"
#include "base/yaml_map.h"

#include <spawnfield/audit.h>

#include <cmath>

namespace spawnfield {
namespace {

const std::vector<std::string> rule_keys{"min_free_area", "max_islands",  "max_closed_rooms",
                                         "max_overlaps",  "max_floating", "max_sunken",
                                         "max_missing",   "require",      "allow"};

/// Reads the largest number that is allowed of something.
std::optional<std::size_t> count_in(const YamlMap& map, const std::string& key)
{
    constexpr double most = 1e9;
    if (!map.has(key)) return std::nullopt;
    return std::size_t(map.whole(key, 0, most));
}

/// Reads one pose of `require`: [x, y, z, yaw] in m and rad.
Pose pose_in(const YamlMap& map, const YAML::Node& node, std::size_t entry)
{
    const std::string what = "entry " + std::to_string(entry) + " ";
    std::vector<double> numbers;
    for (const YAML::Node& item : node) {
        double value = 0;
        if (!item.IsScalar() || !parse_number(item.Scalar(), value) || !std::isfinite(value))
            map.fail("require", what + "has a value that is not a finite number, needs [x, y, z, yaw] in m and rad");
        numbers.push_back(value);
    }
    if (numbers.size() != 4)
        map.fail("require",
                 what + "has " + std::to_string(numbers.size()) + " numbers, needs [x, y, z, yaw] in m and rad");
    return {{numbers[0], numbers[1], numbers[2]}, rotation_from_rpy(0, 0, numbers[3])};
}

void read_required(const YamlMap& map, AuditRules& out)
{
    if (!map.has("require")) return;
    if (!map.is_list("require")) {
        if (map.text("require") != "all")
            map.fail("require", "is \"" + map.text("require") +
                                    "\", needs a list of poses (names, or [x, y, z, yaw] in m and rad), or all");
        out.requires_all = true;
        return;
    }
    std::size_t entry = 0;
    for (const YAML::Node& node : map.list("require")) {
        ++entry;
        if (node.IsSequence())
            out.poses.push_back({"require " + std::to_string(entry), pose_in(map, node, entry)});
        else if (node.IsScalar() && !node.Scalar().empty())
            out.required.push_back(node.Scalar());
        else
            map.fail("require",
                     "entry " + std::to_string(entry) + " is neither a name nor [x, y, z, yaw] in m and rad");
    }
}

}  // namespace

AuditRules read_audit_rules(const std::filesystem::path& file)
{
    const YamlMap map = read_yaml(file);
    map.only(rule_keys);
    AuditRules out;
    if (map.has("min_free_area")) {
        out.min_free_area = map.finite("min_free_area");
        if (*out.min_free_area < 0) map.fail("min_free_area", "is " + number(*out.min_free_area) + ", needs >= 0 m2");
    }
    out.max_islands = count_in(map, "max_islands");
    out.max_closed_rooms = count_in(map, "max_closed_rooms");
    out.max_overlaps = count_in(map, "max_overlaps");
    out.max_floating = count_in(map, "max_floating");
    out.max_sunken = count_in(map, "max_sunken");
    out.max_missing = count_in(map, "max_missing");
    read_required(map, out);
    if (map.has("allow"))
        for (const YAML::Node& node : map.list("allow")) {
            if (!node.IsScalar() || node.Scalar().empty())
                map.fail("allow", "has an entry that is not a glob of parts");
            out.allow.push_back(node.Scalar());
        }
    return out;
}

}  // namespace spawnfield
