// A module that was left over from an older version.
extern "C" const char* const spawnfield_mesh_reader_version;
const char* const spawnfield_mesh_reader_version = "0.1.0";
extern "C" const int spawnfield_mesh_reader_functions;
const int spawnfield_mesh_reader_functions = 0;
