#include "scene/mesh_checks.h"

#include "base/bytes.h"
#include "base/text.h"
#include "scene/ply_file.h"

#include <spawnfield/error.h>

#include <assimp/BaseImporter.h>
#include <assimp/importerdesc.h>

#include <algorithm>
#include <memory>

namespace spawnfield {
namespace {

constexpr unsigned most_corners = 32767;  // assimp's own limit (AI_MAX_FACE_INDICES); its polygon cutter takes the square of it

constexpr aiImporterDesc ply_description{"spawnfield's reader of PLY", "", "", "", aiImporterFlags_SupportBinaryFlavour, 0, 0, 0, 0, "ply"};

/// Gives assimp a mesh that is already read, so that polygons are cut into triangles like those of all other formats.
class PlyImporter : public Assimp::BaseImporter {
public:
    explicit PlyImporter(PlyMesh mesh) : mesh_(std::move(mesh)) {}

    bool CanRead(const std::string&, Assimp::IOSystem*, bool) const override { return true; }
    const aiImporterDesc* GetInfo() const override { return &ply_description; }

protected:
    void InternReadFile(const std::string&, aiScene* scene, Assimp::IOSystem*) override
    {
        auto* const mesh = new aiMesh;  // the scene owns it, as all below
        scene->mMeshes = new aiMesh*[1]{mesh};
        scene->mNumMeshes = 1;
        scene->mMaterials = new aiMaterial*[1]{new aiMaterial};
        scene->mNumMaterials = 1;
        scene->mRootNode = new aiNode;
        scene->mRootNode->mMeshes = new unsigned[1]{0};
        scene->mRootNode->mNumMeshes = 1;
        mesh->mVertices = new aiVector3D[mesh_.vertices.size()];
        mesh->mNumVertices = unsigned(mesh_.vertices.size());
        for (std::size_t v = 0; v < mesh_.vertices.size(); ++v) mesh->mVertices[v] = {mesh_.vertices[v][0], mesh_.vertices[v][1], mesh_.vertices[v][2]};
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

void replace_importers(Assimp::Importer& importer, std::unique_ptr<Assimp::BaseImporter> with)
{
    for (std::size_t i = importer.GetImporterCount(); i-- > 0;) {
        Assimp::BaseImporter* const old = importer.GetImporter(i);
        importer.UnregisterLoader(old);
        delete old;
    }
    importer.RegisterLoader(with.release());
}

}  // namespace

void check_mesh_file(const std::filesystem::path& file, Assimp::Importer& importer)
{
    const Bytes bytes = map_file(file);
    if (lower_case(file.extension().string()) != ".ply" && !is_ply(bytes.view)) return;
    PlyMesh mesh = parse_ply(bytes.view, file.string());
    if (mesh.face_ends.empty()) throw FileError(file.string(), "has no triangles, needs at least one");
    replace_importers(importer, std::make_unique<PlyImporter>(std::move(mesh)));
}

void check_mesh_scene(const aiScene& scene, const std::string& file)
{
    for (unsigned m = 0; m < scene.mNumMeshes; ++m) {
        const aiMesh& mesh = *scene.mMeshes[m];
        const auto fault = [&](unsigned face, const std::string& what) {
            const std::string name = mesh.mName.length > 0 ? "mesh \"" + std::string(mesh.mName.C_Str()) + "\"" : "mesh " + std::to_string(m + 1);
            return FileError(file, name + ": face " + std::to_string(face + 1) + " of " + std::to_string(mesh.mNumFaces) + " has " + what);
        };
        for (unsigned f = 0; f < mesh.mNumFaces; ++f) {
            const aiFace& face = mesh.mFaces[f];
            if (face.mNumIndices < 1 || face.mNumIndices > most_corners)
                throw fault(f, std::to_string(face.mNumIndices) + " corners, needs 3 .. " + std::to_string(most_corners) + "; cut it into triangles");
            for (unsigned c = 0; c < face.mNumIndices; ++c)
                if (face.mIndices[c] >= mesh.mNumVertices)
                    throw fault(f, "the corner " + std::to_string(face.mIndices[c]) + ", needs one of the " + std::to_string(mesh.mNumVertices) + " vertices");
        }
    }
}

}  // namespace spawnfield
