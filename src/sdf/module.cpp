#include "model/sdf_module.h"

extern "C" const spawnfield::sdf_module::Functions spawnfield_sdf_functions;
const spawnfield::sdf_module::Functions spawnfield_sdf_functions{&spawnfield::sdf_module::read_file,
                                                                 &spawnfield::sdf_module::read_model};
