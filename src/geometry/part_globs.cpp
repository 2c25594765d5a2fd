#include "geometry/part_globs.h"

#include "scene/glob.h"
#include "scene/label_rules.h"

namespace spawnfield {
namespace {

bool matches_name(const std::string& glob, const std::string& name)
{
    if (matches(glob, name)) return true;
    if (name.find("::") == std::string::npos) return false;
    for (std::size_t from = 0;;) {
        const std::size_t end = name.find("::", from);
        if (matches(glob, name.substr(from, end == std::string::npos ? end : end - from))) return true;
        if (end == std::string::npos) return false;
        from = end + 2;
    }
}

constexpr std::size_t shown_names = 8;
constexpr const char* advice = " (`spawnfield info MAP` lists them; * stands for any text)";

Names part_names(const Geometry& geometry)
{
    Names out;
    for (std::size_t part = 0; part < geometry.parts().size(); ++part)
        if (!geometry.is_removed(part)) out.push_back(geometry.parts()[part].name);
    return out;
}

}  // namespace

std::vector<std::size_t> parts_that_match(const Geometry& geometry, const std::string& glob)
{
    std::vector<std::size_t> out;
    for (std::size_t part = 0; part < geometry.parts().size(); ++part)
        if (!geometry.is_removed(part) && matches_name(glob, geometry.parts()[part].name)) out.push_back(part);
    return out;
}

std::vector<std::size_t> face_groups_that_match(const Geometry& geometry, const std::string& glob)
{
    std::vector<std::size_t> out;
    for (std::size_t k = 0; k < geometry.face_groups().size(); ++k) {
        const FaceGroup& group = geometry.face_groups()[k];
        const auto matches = [&](const std::string& name) { return !name.empty() && matches_name(glob, name); };
        if (!geometry.is_removed(group.part) && (matches(group.node) || matches(group.material))) out.push_back(k);
    }
    return out;
}

std::string no_part_matches(const Geometry& geometry, const std::string& glob)
{
    const Names names = part_names(geometry);
    return "\"" + glob + "\" matches no part of the map; " +
           (names.empty() ? "it has none" : "there are " + first_of(names, shown_names)) + advice;
}

std::string no_name_matches(const Geometry& geometry, const std::string& glob)
{
    std::vector<FaceGroup> groups;
    for (const FaceGroup& group : geometry.face_groups())
        if (!geometry.is_removed(group.part)) groups.push_back(group);
    const Names names = names_of(groups);
    if (names.empty()) return no_part_matches(geometry, glob);
    return "\"" + glob + "\" matches no part of the map, and no node or material of its meshes; there are the parts " +
           first_of(part_names(geometry), shown_names) + " and the names " + first_of(names, shown_names) + advice;
}

}  // namespace spawnfield
