#include "mesh_reader/printing_units.h"

#include "base/bytes.h"
#include "base/input_file.h"
#include "mesh_reader/package_3mf.h"
#include "mesh_reader/tag_text.h"

#include <spawnfield/error.h>

#include <algorithm>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace spawnfield {
namespace {

/// Returns the attribute `unit` of the first element with this name, with or without a namespace prefix; "" if there is
/// none.
std::string unit_of(std::string_view name, std::string_view text)
{
    for (std::size_t start = text.find(name); start != std::string_view::npos; start = text.find(name, start + 1)) {
        const std::size_t end = start + name.size();
        if (start == 0 || (text[start - 1] != '<' && text[start - 1] != ':') || end == text.size() ||
            !is_xml_space(text[end]))
            continue;
        return attribute(text.substr(end, std::min(text.find('>', end), text.size()) - end), "unit");
    }
    return {};
}

using Units = std::vector<std::pair<std::string, double>>;

double metres_of(const std::string& unit, const Units& units, const std::string& file)
{
    if (unit.empty()) return 1e-3;  // both formats: millimetres without an attribute
    std::string names;
    for (const auto& [known, metres] : units) {
        if (unit == known) return metres;
        names += (names.empty() ? "" : ", ") + known;
    }
    throw FileError(file, "has the unit \"" + unit + "\", needs one of " + names);
}

constexpr std::size_t head = 1 << 16;  // bytes; the root element must lie in this first part of the file

}  // namespace

double metres_per_unit_of_3mf(const std::filesystem::path& file)
{
    const std::string text = model_of_3mf(map_file(file).view, head);
    if (text.empty())
        throw FileError(
            file.string(),
            "has no 3D model at the path that its _rels/.rels names, so its unit is unknown; export it again");
    return metres_of(unit_of("model", text),
                     {{"micron", 1e-6},
                      {"millimeter", 1e-3},
                      {"centimeter", 1e-2},
                      {"inch", 0.0254},
                      {"foot", 0.3048},
                      {"meter", 1}},
                     file.string());
}

double metres_per_unit_of_amf(const std::filesystem::path& file)
{
    return metres_of(unit_of("amf", read_file(file).substr(0, head)),
                     {{"micron", 1e-6}, {"millimeter", 1e-3}, {"inch", 0.0254}, {"feet", 0.3048}, {"meter", 1}},
                     file.string());
}

}  // namespace spawnfield
