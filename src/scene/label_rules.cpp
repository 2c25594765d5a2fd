#include "scene/label_rules.h"

#include "scene/ground_rules.h"

#include <algorithm>
#include <map>
#include <set>

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
    for (const LabelRule& rule : rules) out.push_back({rule.pattern, rule.pattern, rule.label, true});
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

Names names_of(std::span<const FaceGroup> groups)
{
    Names out;
    std::set<std::string> known;
    for (const FaceGroup& group : groups)
        for (const std::string& name : {group.node, group.material})
            if (!name.empty() && known.insert(name).second) out.push_back(name);
    return out;
}

namespace {

/// Returns the option that labels only this name, quoted for a shell: "--label 'floor\[1]=terrain'".
std::string option_for(const std::string& name)
{
    std::string out = "--label '";
    for (const char c : name) {
        if (c == '*' || c == '?' || c == '[' || c == '\\') out += '\\';
        out += c == '\'' ? std::string("'\\''") : std::string(1, c);
    }
    return out + "=terrain'";
}

/// Returns options that label the names that look like ground, and no others. One option labels all names with the same
/// ground word, if no other name contains it.
Names options_for_ground(const Names& names)
{
    Names out;
    std::map<std::string, bool> is_safe;  // for each ground word: all names that contain it look like ground
    for (const std::string& name : names) {
        const std::string word = ground_word(name), glob = "*" + word + "*";
        if (word.empty()) continue;
        const auto [known, is_new] = is_safe.try_emplace(word);
        if (is_new)
            known->second = std::none_of(names.begin(), names.end(), [&](const std::string& other) {
                return matches(glob, other) && ground_word(other).empty();
            });
        if (!known->second)
            out.push_back(option_for(name));
        else if (is_new)
            out.push_back("--label '" + glob + "=terrain'");
    }
    return out;
}

}  // namespace

std::string labelling_advice(const Scene& scene)
{
    constexpr std::size_t most = 8;
    const Names all = options_for_ground(names_of(scene.face_groups));
    std::string options;
    for (std::size_t i = 0; i < std::min(most, all.size()); ++i) options += " " + all[i];
    const std::string by_slope =
        "--auto-label slope=30 labels faces that look up and are less steep than 30 degrees as terrain, and the others "
        "as obstacle";
    if (all.empty()) return by_slope + ". --label 'GLOB=terrain' labels by name (`info` lists the names)";
    return by_slope + ". These names look like ground:" + options +
           (all.size() > most ? " and " + std::to_string(all.size() - most) + " more" : "");
}

void note_unused_rules(const std::filesystem::path& file, const std::vector<LabelRule>& rules, const Names& names,
                       Scene& scene)
{
    for (const LabelRule& rule : rules)
        if (!matches_one(rule.pattern, names))
            scene.notices.push_back(file.string() + ": label \"" + rule.pattern +
                                    "\" matches no node, material or part; there are " + first_of(names, 8));
}

}  // namespace spawnfield
