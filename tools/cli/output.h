#pragma once

#include "common_args.h"

#include <functional>
#include <string>
#include <string_view>

namespace spawnfield::cli {

/// Writes to `file`, completely or not at all; to the host's standard output, if it wants text, if the name is empty or
/// `-`. That gets the text when it is complete. `then` runs when everything is written but the file does not have its
/// name yet. The file gets the name only if `then` succeeds, too.
void write_output(
    const CommonArgs& args, const std::string& file,
    const std::function<void(const std::function<void(std::string_view)>&)>& writer,
    const std::function<void()>& then = [] {});

}  // namespace spawnfield::cli
