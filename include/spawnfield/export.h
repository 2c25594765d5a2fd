#pragma once

/// Marks the functions and classes that the library exports. All its other symbols are hidden.
#define SPAWNFIELD_API __attribute__((visibility("default")))

/// Marks functions that only the library's own modules may call. They may change with every version.
#define SPAWNFIELD_MODULE_API SPAWNFIELD_API
