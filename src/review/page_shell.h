#pragma once

#include <string_view>

namespace spawnfield {

/// Returns the page without its data, which tools/build-web.sh makes from web/; empty if the library was built without
/// it.
std::string_view page_shell();

}  // namespace spawnfield
