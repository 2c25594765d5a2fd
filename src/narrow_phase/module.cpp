#include "base/module.h"
#include "collision/narrow_phase_module.h"

SPAWNFIELD_MODULE(narrow_phase, &spawnfield::narrow_phase_module::make_part,
                  &spawnfield::narrow_phase_module::make_octree, &spawnfield::narrow_phase_module::meets_triangle,
                  &spawnfield::narrow_phase_module::meets_shape, &spawnfield::narrow_phase_module::meets_octree,
                  &spawnfield::narrow_phase_module::bodies_meet);
