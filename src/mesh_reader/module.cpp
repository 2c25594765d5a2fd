#include "mesh/mesh_reader_module.h"

// The only symbol that this module exports. The library looks it up by name after it has loaded the module.
extern "C" SPAWNFIELD_API const spawnfield::mesh_reader_module::Functions spawnfield_mesh_reader_functions;
const spawnfield::mesh_reader_module::Functions spawnfield_mesh_reader_functions{
    &spawnfield::mesh_reader_module::read, &spawnfield::mesh_reader_module::version};
