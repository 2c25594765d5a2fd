#pragma once

#include <string>

namespace spawnfield::cli {

/// Returns a text as it may go to a terminal. Names in files may contain escape sequences, which could change colours,
/// the title or earlier lines: control characters become \xNN (ECMA-48: C0, DEL and, in UTF-8, C1).
/// `keeps_lines`: line feeds and tabs stay.
std::string printable(const std::string& text, bool keeps_lines);

}  // namespace spawnfield::cli
