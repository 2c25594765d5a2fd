#pragma once

#include <cstdint>
#include <string>
#include <string_view>

namespace spawnfield {

/// Returns at most the first `most` bytes of a file in a ZIP archive; "" if the archive has no file of this name
/// (ignoring ASCII case) or is damaged. Source: PKWARE, APPNOTE.TXT 4.3 (local header, central directory, end of
/// central directory).
std::string file_in_zip(std::string_view archive, const std::string& name, std::size_t most);

/// Returns the size of all files of a ZIP archive after unpacking, as its central directory states it, in bytes.
std::uint64_t unpacked_size(std::string_view archive);

}  // namespace spawnfield
