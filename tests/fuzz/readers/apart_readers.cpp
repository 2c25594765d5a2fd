#include "apart/scene_fields.h"
#include "reader.h"

#include <spawnfield/error.h>
#include <spawnfield/reader_process.h>

#include <sys/resource.h>

#include <chrono>

// Foreign libraries, behind the border that protects the program: files are read in a process of their own, in which
// assimp, libsdformat, OctoMap and libtiff may crash, but not for long and not with much memory.
namespace fuzz {
namespace {

namespace fs = std::filesystem;
using namespace spawnfield;

constexpr double most_seconds = 20, most_megabytes = 1000;

double seconds_now()
{
    return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

double megabytes_of_children()
{
    rusage usage{};
    getrusage(RUSAGE_CHILDREN, &usage);
    return double(usage.ru_maxrss) / 1000;
}

void read_apart(const fs::path& file, const fs::path& program)
{
    const double start = seconds_now();
    const auto check_cost = [&] {
        require(seconds_now() - start < most_seconds, "reading took more than 20 s");
        require(megabytes_of_children() < most_megabytes, "reading took more than 1 GB of memory");
    };
    try {
        const Scene scene = load_scene_apart(file, {.allow_missing = true}, {program});
        require(fault_of(scene).empty(), "a scene has a fault");
    } catch (const FileError&) {
        check_cost();
        throw;
    } catch (const ArgumentError& error) {  // of an option that this file needs
        throw FileError(file.string(), error.what());
    }
    check_cost();
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
