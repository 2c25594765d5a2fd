#pragma once

#include <spawnfield/types.h>

namespace spawnfield {

// Colours as 0xRRGGBB, in pictures and in files of other programs. They are the result of a search that began with the
// hues of Okabe and Ito; people with any kind of colour vision can distinguish them. tests/palette_test.cpp checks
// this: Valid and Collision differ in lightness (CIE L*) by 25 or more, and no two verdicts are closer than 20 (in
// CIEDE2000: Sharma, Wu, Dalal 2005, and in CIE76), in normal vision, protanopia, deuteranopia and tritanopia (Machado,
// Oliveira, Fernandes, A physiologically-based model for simulation of color vision deficiency, 2009, full severity).

/// The colour of each Verdict, by its number.
inline constexpr std::array<std::uint32_t, verdict_count> verdict_palette{
    0x726e77, 0xfff516, 0x9182ff, 0x033cd9, 0xa54c31, 0xc99102, 0x4eedff, 0xbdd5a7, 0x570901, 0x371d4a};

/// The colours of heat maps for columns without a verdict's colour. They differ by at least 11 (CIEDE2000) from those
/// of the verdicts and from each other.
inline constexpr std::uint32_t some_headings_colour = 0x5a9c78, obstacle_colour = 0x141414, no_pose_colour = 0xe9e9e9;

/// The colours of islands in a picture: the largest one, then the next ones, then all others together. Places from
/// which no way leads, and the ground beside all islands, have their own colours. All of these differ by at least 11
/// (CIEDE2000), also from obstacle_colour and no_pose_colour.
inline constexpr std::array<std::uint32_t, 6> island_palette{0xbdd5a7, 0x033cd9, 0xfff516,
                                                             0xa54c31, 0x4eedff, 0x9182ff};
inline constexpr std::uint32_t other_islands_colour = 0x371d4a, no_way_colour = 0xc99102, not_valid_colour = 0x9a9a9a;

/// The colours of spawns in a picture, by the kind of the robot: the first seven kinds, then all others together. They
/// differ by at least 11 (CIEDE2000) from each other and from the colours of valid ground and obstacles. Some are
/// also colours of verdicts; the white rim of a spawn shows that it is not ground.
inline constexpr std::array<std::uint32_t, 8> kind_palette{0xffffff, 0x033cd9, 0xfff516, 0xa54c31,
                                                           0x4eedff, 0x9182ff, 0xc99102, 0x371d4a};
inline constexpr std::uint32_t start_colour = kind_palette[0], goal_colour = kind_palette[2],
                               path_colour = kind_palette[1];

}  // namespace spawnfield
