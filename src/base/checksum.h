#pragma once

#include <xxhash.h>

#include <cstdint>
#include <cstdio>
#include <initializer_list>
#include <memory>
#include <string>
#include <string_view>

namespace spawnfield {

/// Returns the XXH64 hash (Collet, xxHash) of the concatenated texts as 16 hexadecimal digits.
inline std::string checksum(std::initializer_list<std::string_view> texts)
{
    const std::unique_ptr<XXH64_state_t, decltype(&XXH64_freeState)> state(XXH64_createState(), XXH64_freeState);
    XXH64_reset(state.get(), 0);
    for (const std::string_view text : texts) XXH64_update(state.get(), text.data(), text.size());
    char digits[17];
    std::snprintf(digits, sizeof digits, "%016llx", static_cast<unsigned long long>(XXH64_digest(state.get())));
    return digits;
}

inline std::string checksum(std::string_view bytes) { return checksum({bytes}); }

}  // namespace spawnfield
