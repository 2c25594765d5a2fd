#include "mesh_reader/stl_check.h"

#include "base/binary.h"

#include <spawnfield/error.h>

#include <cstdint>

namespace spawnfield {
namespace {

// In bytes, of a binary file: 80 of text and the number of facets; per facet a normal, three corners and two bytes.
constexpr std::size_t comment_size = 80, head_size = 84;
constexpr std::uint64_t facet_size = 50;

void check_text(std::string_view text, const std::string& file)
{
    const std::size_t facet = text.rfind("endfacet"), solid = text.rfind("endsolid");
    if (solid == std::string_view::npos || (facet != std::string_view::npos && solid < facet))
        throw FileError(file,
                        "has no endsolid after its last facet; is it cut short? If it is whole, add a line endsolid");
}

void check_binary(std::string_view bytes, const std::string& file)
{
    if (bytes.size() < head_size)
        throw FileError(file, "is an STL file of " + std::to_string(bytes.size()) + " bytes, needs at least " +
                                  std::to_string(head_size) + "; is it cut short?");
    const std::uint64_t facets = BinaryReader(bytes.substr(comment_size)).get<std::uint32_t>();
    const std::uint64_t expected = head_size + facets * facet_size;
    if (bytes.size() != expected)
        throw FileError(file, "declares " + std::to_string(facets) + " facets, for which a binary STL file has " +
                                  std::to_string(expected) + " bytes, but it has " + std::to_string(bytes.size()) +
                                  (bytes.size() < expected ? "; is it cut short?" : "; export it again"));
}

}  // namespace

void check_stl(std::string_view bytes, const std::string& file)
{
    const bool has_zero = bytes.substr(0, head_size).find('\0') != std::string_view::npos;
    const std::size_t first = bytes.find_first_not_of(" \t\r\n");
    const bool is_solid = first != std::string_view::npos && bytes.substr(first).starts_with("solid");
    // Some binary files begin with "solid", too; but the number of facets of any file below 0.8 GB has a byte 0.
    if (is_solid && !has_zero) return check_text(bytes, file);
    if (has_zero || bytes.size() < head_size) check_binary(bytes, file);
}

}  // namespace spawnfield
