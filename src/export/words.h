#pragma once

#include <spawnfield/types.h>

namespace spawnfield {

/// Returns the meaning of the verdicts' numbers: "0 outside, 1 aerial, …".
inline std::string verdict_numbers()
{
    std::string text;
    for (std::size_t v = 0; v < verdict_count; ++v)
        text += (v > 0 ? ", " : "") + std::to_string(v) + " " + to_string(Verdict(v));
    return text;
}

}  // namespace spawnfield
