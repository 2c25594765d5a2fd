#include "scene/label_rules.h"

#include <algorithm>

namespace spawnfield {

Label label_by_name(const std::string& name, const std::vector<LabelRule>& rules, Label fallback)
{
    for (const LabelRule& rule : rules)
        if (matches(rule.pattern, name)) return rule.label;
    return fallback;
}

std::vector<FaceRule> face_rules(const std::vector<LabelRule>& rules)
{
    std::vector<FaceRule> out;
    for (const LabelRule& rule : rules) out.push_back({rule.pattern, true, true, rule.label});
    return out;
}

bool matches_one(const std::string& pattern, const Names& names)
{
    return std::any_of(names.begin(), names.end(), [&](const std::string& name) { return matches(pattern, name); });
}

void add_names(const Names& more, Names& names)
{
    for (const std::string& name : more)
        if (!name.empty() && std::find(names.begin(), names.end(), name) == names.end()) names.push_back(name);
}

std::string first_of(const Names& names, std::size_t most)
{
    std::string some;
    for (std::size_t i = 0; i < std::min(most, names.size()); ++i) some += (i > 0 ? ", " : "") + names[i];
    return some + (names.size() > most ? ", …" : "");
}

void tell_idle_rules(const std::filesystem::path& file, const std::vector<LabelRule>& rules, const Names& names, Scene& scene)
{
    for (const LabelRule& rule : rules)
        if (!matches_one(rule.pattern, names))
            scene.notices.push_back(file.string() + ": label \"" + rule.pattern + "\" matches no node, material or part; there are " + first_of(names, 8));
}

}  // namespace spawnfield
