#pragma once

/// Marks what the library exports. All its other symbols are hidden.
#define SPAWNFIELD_API __attribute__((visibility("default")))

/// Marks what else the library's own modules call. It may change with every version.
#define SPAWNFIELD_MODULE_API SPAWNFIELD_API
