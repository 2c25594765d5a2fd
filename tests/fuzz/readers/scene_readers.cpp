#include "apart/scene_fields.h"
#include "base/pgm.h"
#include "base/png.h"
#include "base/xml.h"
#include "mesh_reader/collada_check.h"
#include "mesh_reader/gltf_check.h"
#include "mesh_reader/gltf_file.h"
#include "mesh_reader/obj_text.h"
#include "mesh_reader/package_3mf.h"
#include "mesh_reader/ply_file.h"
#include "mesh_reader/printing_units.h"
#include "model/sdf_includes.h"
#include "model/sdf_text.h"
#include "reader.h"
#include "scene/height_file.h"
#include "scene/nav2_map.h"

#include <spawnfield/error.h>
#include <spawnfield/geometry.h>
#include <spawnfield/input_file.h>

#include <algorithm>
#include <stdexcept>

// Our own readers of scenes and of what they name, and our own checks before a foreign library reads a file.
namespace fuzz {
namespace {

namespace fs = std::filesystem;
using namespace spawnfield;

void read_scene(const fs::path& file)
{
    const Scene scene = load_scene(file, {.allow_missing = true});
    require(fault_of(scene).empty(), "a scene has a fault");
}

/// What is done with an SDF file before libsdformat reads it.
void examine_sdf(const fs::path& file)
{
    const auto document = read_sdf_xml(file);
    ModelPaths paths({}, file);
    check_includes(file, *document, paths);
    require(!text_without(*document, {}).empty(), "the text of a document is empty");
}

void read_grid(const fs::path& file)
{
    const std::string extension = file.extension().string();
    std::vector<std::string> notices;
    if (extension == ".yaml") {
        Scene scene;
        append_nav2_map(scene, read_nav2_map(file), Label::Terrain, Label::Obstacle, 2);
        require(fault_of(scene).empty(), "a scene has a fault");
        return;
    }
    if (extension == ".colour") {
        const ColourImage image = read_colour_png(file);
        require(image.samples.size() == std::size_t(image.rows) * std::size_t(image.cols * image.channels),
                "an image has another number of samples");
        return;
    }
    if (extension == ".pgm") {
        const GreyImage image = read_pgm(file);
        require(image.pixels.size() == std::size_t(image.rows) * std::size_t(image.cols),
                "an image has another number of pixels");
        return;
    }
    std::optional<RawLayout> raw;
    if (extension == ".raw") raw = RawLayout{RawLayout::Type::Float32, 3, 5};
    const HeightFile heights = read_height_file(file, raw, true, notices);
    require(heights.image.pixels.size() == std::size_t(heights.image.rows) * std::size_t(heights.image.cols),
            "an image has another number of pixels");
}

void read_ply(const fs::path& file)
{
    const PlyMesh mesh = parse_ply(read_file(file), file.string());
    const auto is_vertex = [&](std::uint32_t corner) { return corner < mesh.vertices.size(); };
    require(std::all_of(mesh.corners.begin(), mesh.corners.end(), is_vertex), "a corner is not a vertex");
    const std::size_t end = mesh.face_ends.empty() ? 0 : mesh.face_ends.back();  // a file may have no faces
    require(std::is_sorted(mesh.face_ends.begin(), mesh.face_ends.end()) && end == mesh.corners.size(),
            "faces do not end where they should");
}

/// What is done with a mesh before assimp reads it.
void examine_mesh(const fs::path& file)
{
    const std::string extension = file.extension().string(), bytes = read_file(file), name = file.string();
    if (extension == ".ply") read_ply(file);
    if (extension == ".obj") readable_obj(bytes);
    if (extension == ".dae") check_collada(bytes, name);
    if (extension == ".amf") metres_per_unit_of_amf(file);
    if (extension == ".gltf" || extension == ".glb") {
        check_gltf(bytes, name);
        examine_gltf(file);
    }
    if (extension == ".3mf") {
        check_3mf(bytes, name);
        model_of_3mf(bytes, 1 << 16);
        metres_per_unit_of_3mf(file);
    }
}

/// Reads what a reader process sends, as its parent does. Throws FileError where the parent does.
template <class Value>
Value value_in(const fs::path& file)
{
    const std::string bytes = read_file(file);
    Value value;
    try {
        ArchiveReader in(bytes);
        in(value);
    } catch (const std::out_of_range&) {
        throw FileError(file.string(), "is cut short");
    }
    const std::string fault = fault_of(value);
    if (!fault.empty()) throw FileError(file.string(), fault);
    return value;
}

void read_archive(const fs::path& file)
{
    if (file.extension() == ".robot") {
        value_in<Robot>(file).bounds();
    } else {
        const Scene scene = value_in<Scene>(file);
        scene.bounds();
        Geometry geometry(scene, 1);
    }
}

}  // namespace

std::vector<Reader> scene_readers()
{
    const std::string wedge =
        "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\n"
        "property float z\nelement face 1\nproperty list uchar int vertex_indices\nend_header\n"
        "0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n";
    const std::string grid = "ncols 3\nnrows 2\nxllcorner 0\nyllcorner 0\ncellsize 1\n1 2 3\n4 5 6\n";
    const std::string grey = "P2 3 2 255\n0 100 254\n255 205 7\n";
    return {{"scenes", {".yaml", ".urdf"}, read_scene, {{"wedge.ply", wedge}, {"grid.asc", grid}}},
            {"sdf_text", {".sdf"}, examine_sdf, {{"m/model.config", ""}}},
            {"grids", {".asc", ".pgm", ".png", ".colour", ".raw", ".yaml"}, read_grid, {{"grey.pgm", grey}}},
            {"meshes", {".ply", ".obj", ".dae", ".amf", ".gltf", ".glb", ".3mf"}, examine_mesh},
            {"archives", {".scene", ".robot"}, read_archive}};
}

}  // namespace fuzz
