#include "seed.h"

#include <charconv>
#include <cstdint>
#include <limits>

namespace tools {

std::string seed_complaint(const std::string& text)
{
    std::uint64_t seed = 0;
    const auto [stop, error] = std::from_chars(text.data(), text.data() + text.size(), seed);
    if (error == std::errc{} && stop == text.data() + text.size()) return "";
    return text + " is not a whole number from 0 to " + std::to_string(std::numeric_limits<std::uint64_t>::max());
}

}  // namespace tools
