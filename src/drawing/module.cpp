#include "base/module.h"
#include "picture/drawing_module.h"

SPAWNFIELD_MODULE(drawing, &spawnfield::drawing_module::write_heatmap, &spawnfield::drawing_module::write_preview,
                  &spawnfield::drawing_module::write_robot_picture);
