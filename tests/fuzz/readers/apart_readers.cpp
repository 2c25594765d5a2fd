#include "apart/scene_fields.h"
#include "reader.h"

#include <spawnfield/error.h>
#include <spawnfield/reader_process.h>

#include <sys/resource.h>

#include <optional>

// Foreign libraries, behind the border that protects the program: files are read in a process of their own, in which
// assimp, libsdformat, OctoMap and libtiff may crash, but not for long and not with much memory.
namespace fuzz {
namespace {

namespace fs = std::filesystem;
using namespace spawnfield;

constexpr double most_seconds = 20, most_megabytes = 1000;

/// Processor time and memory of all child processes so far.
struct Cost {
    double seconds, megabytes;  ///< of all together; of the largest
};

Cost cost_of_children()
{
    rusage usage{};
    getrusage(RUSAGE_CHILDREN, &usage);
    const auto seconds = [](const timeval& time) { return double(time.tv_sec) + 1e-6 * double(time.tv_usec); };
    return {seconds(usage.ru_utime) + seconds(usage.ru_stime), double(usage.ru_maxrss) / 1000};
}

void read_apart(const fs::path& file, const fs::path& program)
{
    const double before = cost_of_children().seconds;
    std::optional<FileError> refused;
    try {
        const Scene scene = load_scene_apart(file, {.allow_missing = true}, {program});
        require(fault_of(scene).empty(), "a scene has a fault");
    } catch (const FileError& error) {
        refused = error;
    } catch (const ArgumentError& error) {  // of an option that this file needs
        refused = FileError(file.string(), error.what());
    }
    const Cost cost = cost_of_children();
    require(cost.seconds - before < most_seconds, "reading took more than 20 s of processor time");
    require(cost.megabytes < most_megabytes, "reading took more than 1 GB of memory");
    if (refused) throw *refused;
}

}  // namespace

std::vector<Reader> apart_readers(const fs::path& program)
{
    const auto read = [=](const fs::path& file) { read_apart(file, program); };
    return {{"apart_meshes", {".stl", ".obj", ".off", ".3ds", ".fbx", ".dae", ".gltf", ".glb", ".3mf"}, read},
            {"apart_sdf", {".sdf", ".world"}, read},
            {"apart_octomaps", {".bt", ".ot"}, read},
            {"apart_tiff", {".tif"}, read}};
}

}  // namespace fuzz
