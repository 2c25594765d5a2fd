#include "mesh_reader/mesh_checks.h"

#include "base/bytes.h"
#include "base/text.h"
#include "mesh_reader/collada_check.h"
#include "mesh_reader/gltf_check.h"
#include "mesh_reader/package_3mf.h"
#include "mesh_reader/ply_file.h"
#include "mesh_reader/stl_check.h"

#include <spawnfield/error.h>

#include <assimp/BaseImporter.h>
#include <assimp/importerdesc.h>

#include <algorithm>
#include <array>
#include <numeric>
#include <string_view>
#include <vector>

namespace spawnfield {
namespace {

// Per face. assimp's own limit (AI_MAX_FACE_INDICES); the time to triangulate a face grows with the square of it.
constexpr unsigned most_corners = 32767;

constexpr unsigned most_node_depth = 1000;  // of nodes; they are visited recursively

constexpr aiImporterDesc ply_description{
    "spawnfield's reader of PLY", "", "", "", aiImporterFlags_SupportBinaryFlavour, 0, 0, 0, 0, "ply"};

/// An assimp importer for a mesh that is already read. So assimp triangulates its polygons like those of all other
/// formats.
class PlyImporter : public Assimp::BaseImporter {
public:
    explicit PlyImporter(PlyMesh mesh) : mesh_(std::move(mesh)) {}

    bool CanRead(const std::string&, Assimp::IOSystem*, bool) const override { return true; }
    const aiImporterDesc* GetInfo() const override { return &ply_description; }

protected:
    void InternReadFile(const std::string&, aiScene* scene, Assimp::IOSystem*) override
    {
        auto* const mesh = new aiMesh;  // the scene owns this and all arrays below
        scene->mMeshes = new aiMesh* [1] { mesh };
        scene->mNumMeshes = 1;
        scene->mMaterials = new aiMaterial* [1] { new aiMaterial };
        scene->mNumMaterials = 1;
        scene->mRootNode = new aiNode;
        scene->mRootNode->mMeshes = new unsigned[1]{0};
        scene->mRootNode->mNumMeshes = 1;
        mesh->mVertices = new aiVector3D[mesh_.vertices.size()];
        mesh->mNumVertices = unsigned(mesh_.vertices.size());
        for (std::size_t v = 0; v < mesh_.vertices.size(); ++v)
            mesh->mVertices[v] = {mesh_.vertices[v][0], mesh_.vertices[v][1], mesh_.vertices[v][2]};
        mesh->mFaces = new aiFace[mesh_.face_ends.size()];
        mesh->mNumFaces = unsigned(mesh_.face_ends.size());
        for (std::size_t f = 0, corner = 0; f < mesh_.face_ends.size(); corner = mesh_.face_ends[f++]) {
            aiFace& face = mesh->mFaces[f];
            face.mNumIndices = unsigned(mesh_.face_ends[f] - corner);
            face.mIndices = new unsigned[face.mNumIndices];
            std::copy_n(mesh_.corners.begin() + std::ptrdiff_t(corner), face.mNumIndices, face.mIndices);
        }
    }

private:
    const PlyMesh mesh_;
};

/// Reads a PLY file and makes a PlyImporter the only loader of `importer`.
void use_ply_importer(std::string_view bytes, const std::string& file, Assimp::Importer& importer)
{
    PlyMesh mesh = parse_ply(bytes, file);
    if (mesh.face_ends.empty()) throw FileError(file, "has no triangles, needs at least one");
    for (std::size_t i = importer.GetImporterCount(); i-- > 0;) {
        Assimp::BaseImporter* const old = importer.GetImporter(i);
        importer.UnregisterLoader(old);
        delete old;
    }
    importer.RegisterLoader(new PlyImporter(std::move(mesh)));  // the importer deletes it
}

/// Extensions of the formats that the tests of this project read. Files of other formats crash assimp 5.2 more often.
constexpr std::array tested_extensions = {"3ds", "3mf", "dae", "fbx", "glb", "gltf", "obj", "off", "ply", "stl"};

bool is_tested(std::string_view extension)
{
    return std::find(tested_extensions.begin(), tested_extensions.end(), extension) != tested_extensions.end();
}

/// Throws FileError unless the extension, with its point, is that of a tested format.
void refuse_untested(const std::string& extension, const std::string& file)
{
    if (is_tested(std::string_view(extension).substr(std::min<std::size_t>(1, extension.size())))) return;
    std::string names;
    for (const char* const known : tested_extensions) names += (names.empty() ? "" : ", ") + std::string(known);
    throw FileError(file, "has the extension \"" + extension + "\", needs one of " + names +
                              "; convert it, or read it all the same with --any-mesh");
}

/// Returns the number of triangles after triangulation. Throws FileError unless each face has 1 to most_corners
/// corners, and all corners are vertices of the mesh.
std::uint64_t checked_triangles(const aiMesh& mesh, unsigned index, const std::string& file)
{
    const auto fault = [&](unsigned face, const std::string& what) {
        const std::string name = mesh.mName.length > 0 ? "mesh \"" + std::string(mesh.mName.C_Str()) + "\""
                                                       : "mesh " + std::to_string(index + 1);
        return FileError(file, name + ": face " + std::to_string(face + 1) + " of " + std::to_string(mesh.mNumFaces) +
                                   " has " + what);
    };
    std::uint64_t triangles = 0;
    for (unsigned f = 0; f < mesh.mNumFaces; ++f) {
        const aiFace& face = mesh.mFaces[f];
        if (face.mNumIndices < 1 || face.mNumIndices > most_corners)
            throw fault(f, std::to_string(face.mNumIndices) + " corners, needs 3 .. " + std::to_string(most_corners) +
                               "; cut it into triangles");
        for (unsigned c = 0; c < face.mNumIndices; ++c)
            if (face.mIndices[c] >= mesh.mNumVertices)
                throw fault(f, "the corner " + std::to_string(face.mIndices[c]) + ", needs one of the " +
                                   std::to_string(mesh.mNumVertices) + " vertices");
        triangles += face.mNumIndices > 2 ? face.mNumIndices - 2 : 0;
    }
    return triangles;
}

/// Checks the depth of the nodes and the number of triangles in all instances of meshes. Each node with a mesh is an
/// instance, so a small file can have any number of triangles.
void check_instances(const aiScene& scene, const std::vector<std::uint64_t>& triangles, const std::string& file)
{
    const std::uint64_t in_file = std::accumulate(triangles.begin(), triangles.end(), std::uint64_t(0));
    std::uint64_t all = 0;
    struct Entry {
        const aiNode* node;
        unsigned depth;
    };
    std::vector<Entry> open{{scene.mRootNode, 1}};
    while (!open.empty() && open.back().node != nullptr) {
        const auto [node, depth] = open.back();
        open.pop_back();
        if (depth > most_node_depth)
            throw FileError(file, "node \"" + std::string(node->mName.C_Str()) + "\" is nested more than " +
                                      std::to_string(most_node_depth) + " deep; merge nodes");
        for (unsigned m = 0; m < node->mNumMeshes; ++m) all += triangles.at(node->mMeshes[m]);
        if (all > std::max(most_triangles, in_file))
            throw FileError(file, "its nodes repeat " + std::to_string(in_file) + " triangles to more than " +
                                      std::to_string(most_triangles) +
                                      ", needs fewer; remove instances, or bake parts of the file");
        for (unsigned c = 0; c < node->mNumChildren; ++c) open.push_back({node->mChildren[c], depth + 1});
    }
}

}  // namespace

std::string prepare_import(const std::filesystem::path& file, MeshFormats formats, Assimp::Importer& importer)
{
    const Bytes bytes = map_file(file);
    const std::string extension = lower_case(file.extension().string());
    const std::size_t first = bytes.view.find_first_not_of(" \t\r\n");
    const bool is_json = first != std::string_view::npos && (bytes.view[first] == '{' || bytes.view[first] == '[');
    if (is_json &&
        !importer.IsExtensionSupported(extension))  // assimp would try its glTF reader, whose recursion is not limited
        throw FileError(file.string(), "cannot be read as a mesh: it contains JSON, but \"" + extension +
                                           "\" is not an extension of glTF (.gltf, .glb)");
    if (extension == ".zae")
        throw FileError(
            file.string(),
            "is a packed COLLADA file, which cannot be read here; unpack it (unzip) and give the .dae in it");
    if (formats == MeshFormats::Tested) refuse_untested(extension, file.string());
    if (extension == ".3mf") check_3mf(bytes.view, file.string());
    if (extension == ".gltf" || extension == ".glb")
        check_gltf(bytes.view, file.string());  // assimp decides by the extension, too
    if (extension == ".ply" || is_ply(bytes.view))
        use_ply_importer(bytes.view, file.string(), importer);
    else if (extension == ".stl")
        check_stl(bytes.view, file.string());
    return is_collada(bytes.view, extension) ? check_collada(bytes.view, file.string()) : "";
}

void check_imported_scene(const aiScene& scene, const std::string& file)
{
    std::vector<std::uint64_t> triangles;  // number of triangles of each mesh
    for (unsigned m = 0; m < scene.mNumMeshes; ++m) triangles.push_back(checked_triangles(*scene.mMeshes[m], m, file));
    check_instances(scene, triangles, file);
}

}  // namespace spawnfield
