#include "model/sdf_module.h"

// The only symbol that this module exports. The library looks it up by name after it has loaded the module.
extern "C" SPAWNFIELD_API const spawnfield::sdf_module::Functions spawnfield_sdf_functions;
const spawnfield::sdf_module::Functions spawnfield_sdf_functions{&spawnfield::sdf_module::read_file,
                                                                 &spawnfield::sdf_module::read_model};
