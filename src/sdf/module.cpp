#include "base/module.h"
#include "model/sdf_module.h"

SPAWNFIELD_MODULE(sdf, &spawnfield::sdf_module::read_file, &spawnfield::sdf_module::read_model);
