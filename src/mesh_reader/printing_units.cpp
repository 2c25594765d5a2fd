#include "mesh_reader/printing_units.h"

#include "base/input_file.h"
#include "base/text.h"

#include <spawnfield/error.h>

#include <tinyxml2.h>
#include <zlib.h>

#include <algorithm>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace spawnfield {
namespace {

/// Returns the little-endian number of `size` bytes at `offset`; 0 if the bytes end before it.
std::size_t number_at(std::string_view bytes, std::size_t offset, int size)
{
    if (offset > bytes.size() || bytes.size() - offset < std::size_t(size)) return 0;
    std::size_t value = 0;
    for (int k = size - 1; k >= 0; --k) value = value << 8 | static_cast<unsigned char>(bytes[offset + std::size_t(k)]);
    return value;
}

/// Inflates data in `deflate` format and returns at most its first `most` bytes.
std::string inflated(std::string_view packed, std::size_t most)
{
    constexpr int raw = -MAX_WBITS;  // without zlib's own header
    std::string out(most, '\0');
    z_stream stream{};
    if (inflateInit2(&stream, raw) != Z_OK) return {};
    stream.next_in = reinterpret_cast<Bytef*>(
        const_cast<char*>(packed.data()));  // zlib's old signature; zlib does not write there
    stream.avail_in = uInt(packed.size());
    stream.next_out = reinterpret_cast<Bytef*>(out.data());
    stream.avail_out = uInt(out.size());
    inflate(&stream, Z_FINISH);
    out.resize(stream.total_out);
    inflateEnd(&stream);
    return out;
}

/// Returns at most the first `most` bytes of a file in a ZIP archive; "" if the archive has no file of this name
/// (ignoring ASCII case) or is damaged. Source: PKWARE, APPNOTE.TXT 4.3 (local header, central directory, end of
/// central directory).
std::string file_in(std::string_view archive, const std::string& name, std::size_t most)
{
    constexpr std::size_t end_size = 22, entry_size = 46, header_size = 30, stored = 0, deflated = 8;
    const std::size_t end = archive.rfind("PK\5\6");
    if (end == std::string_view::npos || archive.size() - end < end_size) return {};
    std::size_t entry = number_at(archive, end + 16, 4);
    for (std::size_t remaining = number_at(archive, end + 10, 2); remaining > 0; --remaining) {
        if (entry > archive.size() || !archive.substr(entry).starts_with("PK\1\2") ||
            archive.size() - entry < entry_size)
            return {};
        const std::size_t name_size = number_at(archive, entry + 28, 2);
        if (lower_case(archive.substr(entry + entry_size, name_size)) != lower_case(name)) {
            entry += entry_size + name_size + number_at(archive, entry + 30, 2) + number_at(archive, entry + 32, 2);
            continue;
        }
        const std::size_t header = number_at(archive, entry + 42, 4), method = number_at(archive, entry + 10, 2);
        const std::size_t start = header + header_size + number_at(archive, header + 26, 2) +
                                  number_at(archive, header + 28, 2);
        if (start > archive.size()) return {};
        const std::string_view packed = archive.substr(start, number_at(archive, entry + 20, 4));
        if (method == stored) return std::string(packed.substr(0, most));
        return method == deflated ? inflated(packed, most) : "";
    }
    return {};
}

/// Returns the path of the 3D model in the package, without the leading slash; "" if there is none.
std::string model_name(const std::string& relationships)
{
    tinyxml2::XMLDocument document;
    document.Parse(relationships.c_str());
    const tinyxml2::XMLElement* const root = document.RootElement();
    for (const auto* e = root ? root->FirstChildElement() : nullptr; e != nullptr; e = e->NextSiblingElement()) {
        const char *const type = e->Attribute("Type"), *const target = e->Attribute("Target");
        if (type == nullptr || target == nullptr || !std::string_view(type).ends_with("/3dmodel")) continue;
        return target[0] == '/' ? target + 1 : target;
    }
    return {};
}

bool is_space(char c) { return c == ' ' || c == '\t' || c == '\r' || c == '\n'; }

/// Returns the value of an attribute. `element` is the text of an element after its name. Returns "" if the attribute
/// is missing.
std::string attribute(std::string_view element, std::string_view name)
{
    for (std::size_t start = element.find(name); start != std::string_view::npos;
         start = element.find(name, start + 1)) {
        std::size_t next = start + name.size();
        while (next < element.size() && is_space(element[next])) ++next;
        if (start == 0 || !is_space(element[start - 1]) || next == element.size() || element[next] != '=') continue;
        const std::size_t open = element.find_first_of("\"'", next);
        if (open == std::string_view::npos) return {};
        const std::size_t close = std::min(element.find(element[open], open + 1), element.size());
        return std::string(element.substr(open + 1, close - open - 1));
    }
    return {};
}

/// Returns the attribute `unit` of the first element with this name, with or without a namespace prefix; "" if there is
/// none.
std::string unit_of(std::string_view name, std::string_view text)
{
    for (std::size_t start = text.find(name); start != std::string_view::npos; start = text.find(name, start + 1)) {
        const std::size_t end = start + name.size();
        if (start == 0 || (text[start - 1] != '<' && text[start - 1] != ':') || end == text.size() ||
            !is_space(text[end]))
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
    constexpr std::size_t all = 1 << 20;
    const std::string archive = read_file(file);
    const std::string name = model_name(file_in(archive, "_rels/.rels", all));
    const std::string text = name.empty() ? "" : file_in(archive, name, head);
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
