#include "collision/narrow_phase_module.h"

#include <spawnfield/export.h>

// The only symbol that this module exports. The library looks it up by name after it has loaded the module.
extern "C" SPAWNFIELD_API const spawnfield::narrow_phase_module::Functions spawnfield_narrow_phase_functions;
const spawnfield::narrow_phase_module::Functions spawnfield_narrow_phase_functions{
    &spawnfield::narrow_phase_module::make_part, &spawnfield::narrow_phase_module::make_octree,
    &spawnfield::narrow_phase_module::meets_triangle, &spawnfield::narrow_phase_module::meets_shape,
    &spawnfield::narrow_phase_module::meets_octree};
