#pragma once

#include <nanobind/nanobind.h>

namespace spawnfield::python {

/// Each adds a part of the module `_core`.
void bind_options(nanobind::module_& module);
void bind_results(nanobind::module_& module);
void bind_scenes(nanobind::module_& module);

}  // namespace spawnfield::python
