#include "base/bytes.h"
#include "base/input_file.h"
#include "base/input_watch.h"
#include "base/number.h"
#include "base/text.h"
#include "mesh_reader/gltf_file.h"
#include "mesh_reader/mesh_checks.h"
#include "mesh/mesh_reader_module.h"
#include "mesh_reader/obj_text.h"
#include "mesh/point_numbers.h"
#include "mesh_reader/printing_units.h"

#include <spawnfield/error.h>
#include <spawnfield/input_file.h>

#include <assimp/DefaultIOSystem.h>
#include <assimp/Importer.hpp>
#include <assimp/MemoryIOWrapper.h>
#include <assimp/config.h>
#include <assimp/metadata.h>
#include <assimp/postprocess.h>
#include <assimp/scene.h>
#include <assimp/version.h>
#include <Eigen/LU>

#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>
#include <map>

namespace spawnfield {
namespace {

using Mat4 = Eigen::Matrix4d;

Mat4 matrix_of(const aiMatrix4x4& m)
{
    Mat4 out;
    out << m.a1, m.a2, m.a3, m.a4, m.b1, m.b2, m.b3, m.b4, m.c1, m.c2, m.c3, m.c4, m.d1, m.d2, m.d3, m.d4;
    return out;
}

/// Lets assimp open regular files only. A mesh names other files (materials, buffers), which could be pipes, on which
/// assimp would wait.
class RegularFiles : public Assimp::DefaultIOSystem {
public:
    bool Exists(const char* file) const override { return is_file(file); }

    Assimp::IOStream* Open(const char* file, const char* mode) override
    {
        if (!Exists(file)) return nullptr;
        count_input(file);
        return DefaultIOSystem::Open(file, mode);
    }
};

/// Like RegularFiles, but one file has the given text instead of its own. The text must outlive the object.
class ReplacedFile : public RegularFiles {
public:
    ReplacedFile(std::string file, const std::string& text) : file_(std::move(file)), text_(text) {}

    Assimp::IOStream* Open(const char* file, const char* mode) override
    {
        if (file != file_) return RegularFiles::Open(file, mode);
        return new Assimp::MemoryIOStream(reinterpret_cast<const std::uint8_t*>(text_.data()), text_.size());
    }

private:
    const std::string file_;
    const std::string& text_;
};

/// Returns the text of COLLADA's <up_axis>, or "Y_UP" if the file has none (COLLADA 1.4.1 specification, asset).
std::string collada_up_axis(const std::filesystem::path& file)
{
    const std::string head = read_start(file, 1 << 16);
    const std::string tag = "<up_axis>";
    const std::size_t start = head.find(tag), end = head.find("</up_axis>");
    if (start == std::string::npos || end == std::string::npos) return "Y_UP";
    std::string axis = head.substr(start + tag.size(), end - start - tag.size());
    std::erase_if(axis, [](unsigned char c) { return std::isspace(c); });
    return axis;
}

Mat4 scaled(double factor)
{
    Mat4 out = Mat4::Identity();
    out.topLeftCorner<3, 3>() *= factor;
    return out;
}

/// Sets the up axis of an FBX file and returns the scale from its unit to metres. FBX gives its unit (in cm, 1 by
/// default) and its up axis as metadata, which assimp 5.2 does not apply. Source: Autodesk, FBX SDK, FbxSystemUnit and
/// FbxAxisSystem.
Mat4 read_fbx_frame(const aiScene& scene, FileMesh& mesh)
{
    float centimetres = 1;  // per unit; float is the type of assimp's entry
    std::int32_t up = 1;
    if (scene.mMetaData != nullptr) {
        scene.mMetaData->Get("UnitScaleFactor", centimetres);
        scene.mMetaData->Get("UpAxis", up);
    }
    mesh.up = up == 0 ? 'x' : up == 2 ? 'z' : 'y';
    return scaled(double(centimetres) / 100);
}

/// Returns whether assimp 5.2 rotates a format. 3DS, ASE and DXF are z up, and assimp makes them y up: (x, y, z)
/// becomes (x, z, -y).
bool is_rotated_by_assimp(const std::string& extension)
{
    return extension == ".3ds" || extension == ".prj" || extension == ".ase" || extension == ".ask" ||
           extension == ".dxf";
}

/// Returns the inverse of that rotation, back to the axes of the file.
Mat4 rotated_back()
{
    Mat4 out;
    out << 1, 0, 0, 0, 0, 0, -1, 0, 0, 1, 0, 0, 0, 0, 0, 1;
    return out;
}

/// Collects the faces of one node and welds its vertices: equal coordinates in the file become one vertex.
class NodeWelder {
public:
    NodeWelder(FileMesh::Node& node, const Mat4& transform, const std::string& file)
        : node_(node), transform_(transform), mirrored_(transform.topLeftCorner<3, 3>().determinant() < 0), file_(file)
    {
    }

    /// Adds the faces of the mesh, with `vertices` instead of the mesh's own. Skips faces that are not triangles, and
    /// triangles that have a corner twice.
    void add(const aiMesh& mesh, const aiVector3D* vertices)
    {
        for (unsigned f = 0; f < mesh.mNumFaces; ++f) {
            const aiFace& face = mesh.mFaces[f];
            if (face.mNumIndices != 3) continue;
            Triangle triangle{};
            for (int corner = 0; corner < 3; ++corner) triangle[corner] = vertex(vertices[face.mIndices[corner]]);
            if (mirrored_) std::swap(triangle[1], triangle[2]);
            if (triangle[0] == triangle[1] || triangle[1] == triangle[2] || triangle[2] == triangle[0]) continue;
            node_.triangles.push_back(triangle);
            node_.materials.push_back(mesh.mMaterialIndex);
        }
    }

private:
    std::uint32_t vertex(const aiVector3D& v)
    {
        const auto [index, is_new] = numbers_.add(v.x, v.y, v.z);
        if (is_new) {
            const Eigen::Vector4d point = transform_ * Eigen::Vector4d(v.x, v.y, v.z, 1);
            if (!point.allFinite())
                throw FileError(file_, "node \"" + node_.name + "\": a vertex is (" + number(v.x) + ", " + number(v.y) +
                                           ", " + number(v.z) + "), needs finite coordinates");
            node_.vertices.push_back(point.head<3>());
        }
        return index;
    }

    FileMesh::Node& node_;
    const Mat4 transform_;
    const bool mirrored_;
    const std::string file_;
    PointNumbers<float> numbers_;
};

/// Returns the vertices, moved by the morph targets with their default weights; empty if all weights are 0. Source:
/// glTF 2.0, 3.7.2.2: position = base + sum of weight (target - base).
std::vector<aiVector3D> morphed(const aiMesh& mesh)
{
    std::vector<aiVector3D> out;
    for (unsigned k = 0; k < mesh.mNumAnimMeshes; ++k) {
        const aiAnimMesh& target = *mesh.mAnimMeshes[k];
        if (target.mWeight == 0 || target.mVertices == nullptr || target.mNumVertices != mesh.mNumVertices) continue;
        if (out.empty()) out.assign(mesh.mVertices, mesh.mVertices + mesh.mNumVertices);
        for (unsigned v = 0; v < mesh.mNumVertices; ++v)
            out[v] += target.mWeight * (target.mVertices[v] - mesh.mVertices[v]);
    }
    return out;
}

/// Collects the nodes that have faces, transformed by the node and all its parents.
struct Collector {
    const aiScene& scene;
    std::string file;
    bool morphs = false;  ///< apply the default weights of morph targets
    const ObjText& obj;   ///< names of nodes, if the file is an OBJ

    void visit(const aiNode& node, const Mat4& parent, FileMesh& out) const
    {
        const Mat4 transform = parent * matrix_of(node.mTransformation);
        if (node.mNumMeshes > 0) {
            FileMesh::Node collected;
            collected.name = obj_name(obj, node.mName.C_Str());
            NodeWelder welder(collected, transform, file);
            for (unsigned m = 0; m < node.mNumMeshes; ++m) {
                const aiMesh& mesh = *scene.mMeshes[node.mMeshes[m]];
                const std::vector<aiVector3D> moved = morphs ? morphed(mesh) : std::vector<aiVector3D>{};
                welder.add(mesh, moved.empty() ? mesh.mVertices : moved.data());
            }
            if (!collected.triangles.empty()) out.nodes.push_back(std::move(collected));
        }
        for (unsigned c = 0; c < node.mNumChildren; ++c) visit(*node.mChildren[c], transform, out);
    }
};

/// Adds a notice if the last line of an OBJ or OFF file has no line break. These formats have no mark at their end, and
/// assimp reads what is before the place where a file was cut.
void note_open_end(const std::filesystem::path& file, FileMesh& mesh)
{
    const Bytes bytes = map_file(file);
    if (!bytes.view.ends_with('\n') && !bytes.view.ends_with('\r'))
        mesh.notices.push_back(file.string() +
                               ": its last line has no line break; if the file was cut short, a part "
                               "of its geometry is missing");
}

/// Throws FileError if assimp read fewer triangles than the file has: it skips faces whose vertices do not exist,
/// without any message.
void check_triangles(const aiScene& scene, std::size_t expected, const std::string& file)
{
    std::size_t found = 0;
    for (unsigned m = 0; m < scene.mNumMeshes; ++m)
        if (scene.mMeshes[m]->mPrimitiveTypes & aiPrimitiveType_TRIANGLE) found += scene.mMeshes[m]->mNumFaces;
    if (found < expected)
        throw FileError(file,
                        std::to_string(expected - found) + " of its " + std::to_string(expected) +
                            " triangles refer to a vertex that does not exist; the file is damaged: export it again");
}

}  // namespace

FileMesh mesh_reader_module::read(const std::filesystem::path& file, MeshFormats formats)
{
    require_file(file);
    const std::string extension = lower_case(file.extension().string());
    ObjText obj = extension == ".obj" ? readable_obj(read_file(file)) : ObjText{};
    std::string text;  // replaces that of the file if not empty; must outlive the importer
    Assimp::Importer importer;
    text = prepare_import(file, formats, importer);
    if (extension == ".obj") text = std::move(obj.text);
    const bool is_gltf = extension == ".gltf" || extension == ".glb";
    GltfFacts gltf = is_gltf ? examine_gltf(file) : GltfFacts{};
    if (extension == ".obj" || !text.empty())
        importer.SetIOHandler(new ReplacedFile(file.string(), text));
    else
        importer.SetIOHandler(new RegularFiles);  // the importer owns the handler
    // assimp would rotate every COLLADA file to y up. Instead it keeps the file's own axes here, and turned_up()
    // rotates them as in all other formats.
    importer.SetPropertyBool(AI_CONFIG_IMPORT_COLLADA_IGNORE_UP_DIRECTION, true);
    importer.SetPropertyBool(AI_CONFIG_IMPORT_COLLADA_USE_COLLADA_NAMES,
                             true);  // else label rules would see ids instead of names
    importer.SetPropertyInteger(AI_CONFIG_PP_SBP_REMOVE, aiPrimitiveType_POINT | aiPrimitiveType_LINE);
    const aiScene* scene = importer.ReadFile(file.string(), 0);
    if (scene != nullptr) {
        check_imported_scene(*scene, file.string());
        scene = importer.ApplyPostProcessing(aiProcess_Triangulate | aiProcess_SortByPType);
    }
    if (scene == nullptr || scene->mRootNode == nullptr)
        throw FileError(file.string(), std::string("cannot be read as a mesh: ") + importer.GetErrorString());

    FileMesh mesh;
    for (unsigned m = 0; m < scene->mNumMaterials; ++m)
        mesh.materials.push_back(scene->mMaterials[m]->GetName().C_Str());
    if (is_gltf) {
        check_triangles(*scene, gltf.triangles, file.string());
        mesh.up = 'y';
        mesh.notices = std::move(gltf.notices);
    }
    if (extension == ".obj" || extension == ".off") note_open_end(file, mesh);
    if (extension == ".dae") {
        const std::string up = collada_up_axis(file);
        mesh.up = up == "Z_UP" ? 'z' : up == "X_UP" ? 'x' : 'y';
    }
    const Mat4 metres = extension == ".fbx"               ? read_fbx_frame(*scene, mesh)
                        : is_rotated_by_assimp(extension) ? rotated_back()
                        : extension == ".3mf"             ? scaled(metres_per_unit_of_3mf(file))
                        : extension == ".amf"             ? scaled(metres_per_unit_of_amf(file))
                                                          : Mat4(Mat4::Identity());
    Collector{*scene, file.string(), is_gltf, obj}.visit(*scene->mRootNode, metres, mesh);
    if (mesh.nodes.empty()) throw FileError(file.string(), "has no triangles, needs at least one");
    return mesh;
}

std::string mesh_reader_module::version()
{
    return std::to_string(aiGetVersionMajor()) + "." + std::to_string(aiGetVersionMinor()) + "." +
           std::to_string(aiGetVersionPatch());
}

}  // namespace spawnfield
