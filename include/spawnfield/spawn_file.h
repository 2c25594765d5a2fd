#pragma once

#include <spawnfield/export.h>

#include <functional>
#include <span>
#include <string>
#include <string_view>

namespace spawnfield {

struct SpawnList;

/// Passes the text of spawns_csv() to `sink` in pieces, which takes less memory for many spawns.
SPAWNFIELD_API void write_spawns_csv(const SpawnList& list, std::span<const std::string> names,
                                     const std::function<void(std::string_view)>& sink);

}  // namespace spawnfield
