#include "picture/drawing_module.h"

// The only symbol that this module exports. The library looks it up by name after it has loaded the module.
extern "C" SPAWNFIELD_API const spawnfield::drawing_module::Functions spawnfield_drawing_functions;
const spawnfield::drawing_module::Functions spawnfield_drawing_functions{
    &spawnfield::drawing_module::write_heatmap, &spawnfield::drawing_module::write_preview,
    &spawnfield::drawing_module::write_robot_picture};
