#pragma once

#include <spawnfield/types.h>

namespace spawnfield {

/// 0xRRGGBB of each Verdict, in pictures and in files of other programs.
/// Source: Okabe, Ito, Color Universal Design, 2008.
inline constexpr std::array<std::uint32_t, verdict_count> verdict_palette{0x999999, 0xf0e442, 0xcc79a7, 0x0072b2,
                                                                          0xd55e00, 0xe69f00, 0x56b4e9, 0x009e73};

}  // namespace spawnfield
