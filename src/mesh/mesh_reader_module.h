#pragma once

#include "mesh/mesh_file.h"

/// The interface of the module src/mesh_reader: a shared library that contains all code that uses assimp, and that is
/// loaded when the first mesh file is read. Without the module, each start of a program would load assimp.
namespace spawnfield::mesh_reader_module {

// They do the work of read_mesh() and mesh_reader_version().
FileMesh read(const std::filesystem::path& file, MeshFormats formats);
std::string version();

/// The functions that the module exports.
struct Functions {
    static constexpr const char *module = "mesh_reader", *failure = "mesh files cannot be read";
    decltype(&mesh_reader_module::read) read;
    decltype(&mesh_reader_module::version) version;
};

}  // namespace spawnfield::mesh_reader_module
