#include "geometry/part_globs.h"

#include "scene/glob.h"

namespace spawnfield {
namespace {

bool matches_part(const std::string& glob, const std::string& name)
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
        if (!geometry.is_removed(part) && matches_part(glob, geometry.parts()[part].name)) out.push_back(part);
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
