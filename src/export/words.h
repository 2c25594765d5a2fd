#pragma once

#include <spawnfield/types.h>

#include <algorithm>

namespace spawnfield {

/// What numbers of verdicts mean: "0 outside, 1 aerial, …".
inline std::string verdict_numbers()
{
    std::string text;
    for (std::size_t v = 0; v < verdict_count; ++v)
        text += (v > 0 ? ", " : "") + std::to_string(v) + " " + to_string(Verdict(v));
    return text;
}

/// For a line of a header: names may hold line ends.
inline std::string one_line(std::string text)
{
    std::replace_if(
        text.begin(), text.end(), [](unsigned char c) { return c < ' '; }, ' ');
    return text;
}

}  // namespace spawnfield
