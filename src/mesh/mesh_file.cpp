#include "mesh/mesh_file.h"

#include "base/input_watch.h"
#include "base/module.h"
#include "mesh/mesh_reader_module.h"

namespace spawnfield {

FileMesh read_mesh(const std::filesystem::path& file, MeshFormats formats)
{
    const ForeignReading reading("mesh reader", file);
    return module_functions<mesh_reader_module::Functions>().read(file, formats);
}

std::string mesh_reader_version() { return module_functions<mesh_reader_module::Functions>().version(); }

std::shared_ptr<const FileMesh> MeshFiles::read(const std::filesystem::path& file)
{
    Entry& entry = files_[file];
    if (!entry.mesh) entry.mesh = std::make_shared<const FileMesh>(read_mesh(file, formats_));
    std::shared_ptr<const FileMesh> mesh = entry.mesh;
    if (entry.remaining_uses <= 1)
        entry.mesh.reset();
    else
        --entry.remaining_uses;
    return mesh;
}

}  // namespace spawnfield
