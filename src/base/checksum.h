#pragma once

#include <xxhash.h>

#include <cstdint>
#include <cstdio>
#include <string>
#include <string_view>

namespace spawnfield {

/// Returns the XXH64 hash of the bytes (Collet, xxHash) as 16 hexadecimal digits.
inline std::string checksum(std::string_view bytes)
{
    char text[17];
    std::snprintf(text, sizeof text, "%016llx", static_cast<unsigned long long>(XXH64(bytes.data(), bytes.size(), 0)));
    return text;
}

}  // namespace spawnfield
