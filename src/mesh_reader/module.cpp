#include "base/module.h"
#include "mesh/mesh_reader_module.h"

SPAWNFIELD_MODULE(mesh_reader, &spawnfield::mesh_reader_module::read, &spawnfield::mesh_reader_module::version);
