#include "mesh_reader/gltf_file.h"

#include "base/bytes.h"
#include "mesh_reader/gltf_check.h"

#include <spawnfield/error.h>

#include <nlohmann/json.hpp>

#include <algorithm>
#include <array>
#include <cstdint>
#include <set>

namespace spawnfield {
namespace {

using nlohmann::json;

/// Returns a member of `of`, or null if there is none or `of` is not an object. Files cannot be trusted.
const json& member(const json& of, const char* key)
{
    static const json none;
    if (!of.is_object()) return none;
    const auto found = of.find(key);
    return found == of.end() ? none : *found;
}

/// Returns an element of `of`, or null if the index is not valid or `of` is not an array.
const json& element(const json& of, const json& index)
{
    static const json none;
    return of.is_array() && index.is_number_unsigned() && index.get<std::size_t>() < of.size()
               ? of[index.get<std::size_t>()]
               : none;
}

std::string text_of(const json& value) { return value.is_string() ? value.get<std::string>() : ""; }

/// Returns whether an extension is only about appearance (materials, textures, lights, metadata). A program that does
/// not know it still reads the same geometry.
bool is_about_appearance(const std::string& extension)
{
    static const std::array prefixes{"KHR_materials_",    "KHR_texture_",          "KHR_lights_",
                                     "KHR_xmp",           "EXT_texture_",          "EXT_lights_",
                                     "EXT_materials_",    "MSFT_texture_",         "MSFT_packing_",
                                     "ADOBE_materials_",  "KHR_techniques_webgl",  "EXT_structural_metadata",
                                     "EXT_mesh_features", "EXT_instance_features", "CESIUM_primitive_outline"};
    return std::any_of(prefixes.begin(), prefixes.end(),
                       [&](const char* prefix) { return extension.starts_with(prefix); });
}

/// Returns the remedy for a file with an extension that is not read.
std::string remedy(const std::string& extension)
{
    if (extension == "KHR_mesh_quantization")
        return "write it without quantization by gltf-transform dequantize or gltfpack -noq";
    if (extension == "EXT_mesh_gpu_instancing")
        return "write it without instances by gltf-transform uninstance, or make its instances real in the modeller";
    if (extension == "KHR_draco_mesh_compression") return "write it without compression by gltf-transform copy";
    if (extension == "EXT_meshopt_compression")
        return "write it without compression by gltf-transform copy, or by gltfpack without -c and -cc";
    return "export it without this extension";
}

[[noreturn]] void refuse(const std::filesystem::path& file, const std::string& place, const std::string& extension)
{
    throw FileError(file.string(), place + extension + ", which changes geometry and cannot be read here; " +
                                       remedy(extension) + " (or export it as OBJ or PLY)");
}

void check_required(const json& root, const std::filesystem::path& file)
{
    const json& required = member(root, "extensionsRequired");
    if (!required.is_array()) return;
    for (const json& entry : required) {
        const std::string name = text_of(entry);
        if (is_about_appearance(name)) continue;
        const bool is_known = name == "KHR_mesh_quantization" || name == "EXT_mesh_gpu_instancing" ||
                              name.ends_with("_compression");
        if (is_known) refuse(file, "needs the glTF extension ", name);
        throw FileError(file.string(),
                        "needs the glTF extension " + name +
                            " (extensionsRequired), which is unknown here and may change the geometry; " +
                            remedy(name) + " (or export it as OBJ or PLY)");
    }
}

/// The nodes that assimp reads: those of the scene, of the skins and of the animations, with all their children.
class ReadNodes {
public:
    explicit ReadNodes(const json& root) : root_(root)
    {
        static const json first = 0u;
        const json& scene = member(root, "scene");
        add_all(member(element(member(root, "scenes"), scene.is_null() ? first : scene), "nodes"));
        for (const json& skin : member(root, "skins")) {
            add_all(member(skin, "joints"));
            add(member(skin, "skeleton"));
        }
        for (const json& animation : member(root, "animations"))
            for (const json& channel : member(animation, "channels")) add(member(member(channel, "target"), "node"));
    }

    const std::set<std::size_t>& get() const { return found_; }

private:
    void add_all(const json& indices)
    {
        for (const json& index : indices) add(index);
    }

    void add(const json& first)
    {
        std::vector<const json*> open{&first};
        while (!open.empty()) {
            const json& index = *open.back();
            open.pop_back();
            const json& node = element(member(root_, "nodes"), index);
            if (node.is_null() || !found_.insert(index.get<std::size_t>()).second) continue;
            for (const json& child : member(node, "children")) open.push_back(&child);
        }
    }

    const json& root_;
    std::set<std::size_t> found_;
};

/// Returns the number of triangles of a primitive, from the counts of its accessors; 0 for points and lines.
std::size_t triangles_of(const json& primitive, const json& accessors)
{
    const json& positions = member(member(primitive, "attributes"), "POSITION");
    if (positions.is_null()) return 0;
    const json& indices = member(primitive, "indices");
    const json& count = member(element(accessors, indices.is_null() ? positions : indices), "count");
    const json& mode = member(primitive, "mode");
    const std::size_t corners = count.is_number_unsigned() ? count.get<std::size_t>() : 0;
    if (mode.is_null() || mode == 4) return corners / 3;
    return (mode == 5 || mode == 6) && corners > 2 ? corners - 2 : 0;  // strip, fan
}

void check_positions(const json& attributes, const json& root, const std::filesystem::path& file)
{
    constexpr int is_float = 5126;
    const json& type = member(element(member(root, "accessors"), member(attributes, "POSITION")), "componentType");
    if (type.is_number() && type != is_float)
        refuse(file, "has positions that are not floats, because of ", "KHR_mesh_quantization");
}

/// Refuses a skin with fewer matrices than joints: assimp 5.2 would end the program. glTF allows files without these
/// matrices, but few exist.
void check_skin(const json& node, const json& root, const std::filesystem::path& file)
{
    const json& skin = element(member(root, "skins"), member(node, "skin"));
    const json& count = member(element(member(root, "accessors"), member(skin, "inverseBindMatrices")), "count");
    if (skin.is_null() || (count.is_number_unsigned() && count.get<std::size_t>() >= member(skin, "joints").size()))
        return;
    throw FileError(
        file.string(),
        "skin " + member(node, "skin").dump() +
            " has fewer inverseBindMatrices than joints, which cannot be read; export the file without the skin");
}

/// Returns, for example, `node "crane" and 3 more`.
std::string place_of(const std::vector<std::string>& nodes)
{
    return "node \"" + nodes[0] + "\"" + (nodes.size() > 1 ? " and " + std::to_string(nodes.size() - 1) + " more" : "");
}

}  // namespace

GltfFacts examine_gltf(const std::filesystem::path& file)
{
    const json root = json::parse(gltf_json(map_file(file).view, file.string()), nullptr, false);
    GltfFacts facts;
    if (!text_of(member(member(root, "asset"), "version")).starts_with("2")) return facts;
    check_required(root, file);

    std::set<std::size_t> meshes;
    std::vector<std::string> skinned, posed;
    const ReadNodes read(root);
    for (const std::size_t index : read.get()) {
        const json& node = member(root, "nodes")[index];
        const json& mesh = member(node, "mesh");
        if (element(member(root, "meshes"), mesh).is_null()) continue;
        meshes.insert(mesh.get<std::size_t>());
        const std::string name = member(node, "name").is_string() ? text_of(member(node, "name"))
                                                                  : std::to_string(index);
        if (!member(member(node, "extensions"), "EXT_mesh_gpu_instancing").is_null())
            refuse(file, "node \"" + name + "\" has instances, by ", "EXT_mesh_gpu_instancing");
        check_skin(node, root, file);
        if (!member(node, "skin").is_null()) skinned.push_back(name);
        if (!member(node, "weights").is_null()) posed.push_back(name);
    }
    for (const std::size_t index : meshes)
        for (const json& primitive : member(member(root, "meshes")[index], "primitives")) {
            check_positions(member(primitive, "attributes"), root, file);
            for (const json& target : member(primitive, "targets")) check_positions(target, root, file);
            facts.triangles += triangles_of(primitive, member(root, "accessors"));
        }
    if (!skinned.empty())
        facts.notices.push_back(file.string() + ": " + place_of(skinned) +
                                ": the joints of its skin are ignored, so the mesh has the shape in which it was "
                                "modelled; apply the armature in the modeller if you need another shape");
    if (!posed.empty())
        facts.notices.push_back(file.string() + ": " + place_of(posed) +
                                ": the morph target weights of a node are ignored; those of its mesh are used");
    return facts;
}

}  // namespace spawnfield
