#pragma once

#include <string_view>

namespace spawnfield {

/// Returns the page without its data, which tools/build-web.sh makes from web/; empty if the library was built without
/// it.
std::string_view page_shell();

/// Returns the Content-Security-Policy of the page: what a page must allow that contains this one in a frame.
std::string_view page_policy();

}  // namespace spawnfield
