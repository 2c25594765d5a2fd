#include "geometry/part_globs.h"

#include "scene/glob.h"

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
    constexpr std::size_t shown = 8;
    std::string names;
    std::size_t count = 0;
    for (std::size_t part = 0; part < geometry.parts().size(); ++part)
        if (!geometry.is_removed(part) && ++count <= shown)
            names += (count > 1 ? ", " : "") + geometry.parts()[part].name;
    return "\"" + glob + "\" matches no part of the map; " +
           (count == 0 ? "it has none" : "there are " + names + (count > shown ? ", …" : "")) +
           " (`spawnfield info MAP` lists them; * stands for any text)";
}

}  // namespace spawnfield
