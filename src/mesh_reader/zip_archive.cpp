#include "mesh_reader/zip_archive.h"

#include "base/text.h"

#include <zlib.h>

#include <algorithm>
#include <vector>

namespace spawnfield {
namespace {

constexpr std::size_t end_size = 22, entry_size = 46, header_size = 30, stored = 0, deflated = 8;  // bytes; methods

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

/// Returns where the entries of the central directory begin, as far as they are not damaged.
std::vector<std::size_t> entries_of(std::string_view archive)
{
    const std::size_t end = archive.rfind("PK\5\6");
    if (end == std::string_view::npos || archive.size() - end < end_size) return {};
    std::vector<std::size_t> entries;
    std::size_t entry = number_at(archive, end + 16, 4);
    for (std::size_t remaining = number_at(archive, end + 10, 2); remaining > 0; --remaining) {
        if (entry > archive.size() || !archive.substr(entry).starts_with("PK\1\2") ||
            archive.size() - entry < entry_size)
            break;
        entries.push_back(entry);
        entry += entry_size + number_at(archive, entry + 28, 2) + number_at(archive, entry + 30, 2) +
                 number_at(archive, entry + 32, 2);
    }
    return entries;
}

}  // namespace

std::string file_in_zip(std::string_view archive, const std::string& name, std::size_t most)
{
    for (const std::size_t entry : entries_of(archive)) {
        if (lower_case(archive.substr(entry + entry_size, number_at(archive, entry + 28, 2))) != lower_case(name))
            continue;
        const std::size_t header = number_at(archive, entry + 42, 4), method = number_at(archive, entry + 10, 2);
        const std::size_t start = header + header_size + number_at(archive, header + 26, 2) +
                                  number_at(archive, header + 28, 2);
        if (start > archive.size()) return {};
        const std::string_view packed = archive.substr(start, number_at(archive, entry + 20, 4));
        if (method == stored) return std::string(packed.substr(0, most));
        return method == deflated ? inflated(packed, std::min(most, number_at(archive, entry + 24, 4))) : "";
    }
    return {};
}

std::uint64_t unpacked_size(std::string_view archive)
{
    std::uint64_t all = 0;
    for (const std::size_t entry : entries_of(archive)) all += number_at(archive, entry + 24, 4);
    return all;
}

}  // namespace spawnfield
