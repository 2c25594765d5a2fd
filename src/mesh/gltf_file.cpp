#include "mesh/gltf_file.h"

#include "base/bytes.h"
#include "mesh/gltf_check.h"

#include <spawnfield/error.h>

#include <nlohmann/json.hpp>

#include <algorithm>
#include <array>
#include <cstdint>
#include <set>

namespace spawnfield {
namespace {

using nlohmann::json;

/// The member or element; null if there is none or `of` has none: files are not to be trusted.
const json& at(const json& of, const char* key)
{
    static const json none;
    if (!of.is_object()) return none;
    const auto found = of.find(key);
    return found == of.end() ? none : *found;
}

const json& at(const json& of, const json& index)
{
    static const json none;
    return of.is_array() && index.is_number_unsigned() && index.get<std::size_t>() < of.size()
               ? of[index.get<std::size_t>()]
               : none;
}

std::string text_of(const json& value) { return value.is_string() ? value.get<std::string>() : ""; }

/// Materials, textures, lights and metadata: whoever does not know them sees the same geometry.
bool is_about_looks(const std::string& extension)
{
    static const std::array prefixes{"KHR_materials_",    "KHR_texture_",          "KHR_lights_",
                                     "KHR_xmp",           "EXT_texture_",          "EXT_lights_",
                                     "EXT_materials_",    "MSFT_texture_",         "MSFT_packing_",
                                     "ADOBE_materials_",  "KHR_techniques_webgl",  "EXT_structural_metadata",
                                     "EXT_mesh_features", "EXT_instance_features", "CESIUM_primitive_outline"};
    return std::any_of(prefixes.begin(), prefixes.end(),
                       [&](const char* prefix) { return extension.starts_with(prefix); });
}

/// What the user can do about an extension that is not read.
std::string remedy(const std::string& extension)
{
    if (extension == "KHR_mesh_quantization") return "gltf-transform dequantize, or gltfpack -noq, writes it without";
    if (extension == "EXT_mesh_gpu_instancing")
        return "glTF Transform's uninstance, or the modeller by making its instances real, writes it without";
    if (extension == "KHR_draco_mesh_compression") return "gltf-transform copy writes it without";
    if (extension == "EXT_meshopt_compression")
        return "gltf-transform copy writes it without, or gltfpack without -c or -cc";
    return "export it without";
}

[[noreturn]] void refuse(const std::filesystem::path& file, const std::string& place, const std::string& extension)
{
    throw FileError(file.string(), place + extension + ", which changes geometry and is not known here; " +
                                       remedy(extension) + " (or export it as OBJ or PLY)");
}

void check_required(const json& root, const std::filesystem::path& file)
{
    const json& required = at(root, "extensionsRequired");
    if (!required.is_array()) return;
    for (const json& entry : required) {
        const std::string name = text_of(entry);
        if (is_about_looks(name)) continue;
        const bool is_known = name == "KHR_mesh_quantization" || name == "EXT_mesh_gpu_instancing" ||
                              name.ends_with("_compression");
        if (is_known) refuse(file, "needs the glTF extension ", name);
        throw FileError(file.string(),
                        "needs the glTF extension " + name +
                            " (extensionsRequired), which is not known here, so its geometry may be wrong; " +
                            remedy(name) + " (or export it as OBJ or PLY)");
    }
}

/// Nodes that assimp reads: of the scene, the skins and the animations, with all their children.
class ReadNodes {
public:
    explicit ReadNodes(const json& root) : root_(root)
    {
        static const json first = 0u;
        const json& scene = at(root, "scene");
        add_all(at(at(at(root, "scenes"), scene.is_null() ? first : scene), "nodes"));
        for (const json& skin : at(root, "skins")) {
            add_all(at(skin, "joints"));
            add(at(skin, "skeleton"));
        }
        for (const json& animation : at(root, "animations"))
            for (const json& channel : at(animation, "channels")) add(at(at(channel, "target"), "node"));
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
            const json& node = at(at(root_, "nodes"), index);
            if (node.is_null() || !found_.insert(index.get<std::size_t>()).second) continue;
            for (const json& child : at(node, "children")) open.push_back(&child);
        }
    }

    const json& root_;
    std::set<std::size_t> found_;
};

/// Triangles of a primitive by the counts of its accessors; 0 for points and lines.
std::size_t triangles_of(const json& primitive, const json& accessors)
{
    const json& positions = at(at(primitive, "attributes"), "POSITION");
    if (positions.is_null()) return 0;
    const json& indices = at(primitive, "indices");
    const json& count = at(at(accessors, indices.is_null() ? positions : indices), "count");
    const json& mode = at(primitive, "mode");
    const std::size_t corners = count.is_number_unsigned() ? count.get<std::size_t>() : 0;
    if (mode.is_null() || mode == 4) return corners / 3;
    return (mode == 5 || mode == 6) && corners > 2 ? corners - 2 : 0;  // strip, fan
}

void check_positions(const json& attributes, const json& root, const std::filesystem::path& file)
{
    constexpr int is_float = 5126;
    const json& type = at(at(at(root, "accessors"), at(attributes, "POSITION")), "componentType");
    if (type.is_number() && type != is_float)
        refuse(file, "has positions that are no floats, by ", "KHR_mesh_quantization");
}

/// assimp 5.2 ends the program where a skin has fewer matrices than joints. glTF lets them be left out, which few do.
void check_skin(const json& node, const json& root, const std::filesystem::path& file)
{
    const json& skin = at(at(root, "skins"), at(node, "skin"));
    const json& count = at(at(at(root, "accessors"), at(skin, "inverseBindMatrices")), "count");
    if (skin.is_null() || (count.is_number_unsigned() && count.get<std::size_t>() >= at(skin, "joints").size())) return;
    throw FileError(
        file.string(),
        "skin " + at(node, "skin").dump() +
            ": has no inverseBindMatrices for all of its joints, and cannot be read so; export it without a skin");
}

/// "node "crane" and 3 more".
std::string place_of(const std::vector<std::string>& nodes)
{
    return "node \"" + nodes[0] + "\"" + (nodes.size() > 1 ? " and " + std::to_string(nodes.size() - 1) + " more" : "");
}

}  // namespace

GltfFacts examine_gltf(const std::filesystem::path& file)
{
    const json root = json::parse(gltf_json(map_file(file).view, file.string()), nullptr, false);
    GltfFacts facts;
    if (!text_of(at(at(root, "asset"), "version")).starts_with("2")) return facts;
    check_required(root, file);

    std::set<std::size_t> meshes;
    std::vector<std::string> skinned, posed;
    const ReadNodes read(root);
    for (const std::size_t index : read.get()) {
        const json& node = at(root, "nodes")[index];
        const json& mesh = at(node, "mesh");
        if (at(at(root, "meshes"), mesh).is_null()) continue;
        meshes.insert(mesh.get<std::size_t>());
        const std::string name = at(node, "name").is_string() ? text_of(at(node, "name")) : std::to_string(index);
        if (!at(at(node, "extensions"), "EXT_mesh_gpu_instancing").is_null())
            refuse(file, "node \"" + name + "\": has instances by ", "EXT_mesh_gpu_instancing");
        check_skin(node, root, file);
        if (!at(node, "skin").is_null()) skinned.push_back(name);
        if (!at(node, "weights").is_null()) posed.push_back(name);
    }
    for (const std::size_t index : meshes)
        for (const json& primitive : at(at(root, "meshes")[index], "primitives")) {
            check_positions(at(primitive, "attributes"), root, file);
            for (const json& target : at(primitive, "targets")) check_positions(target, root, file);
            facts.triangles += triangles_of(primitive, at(root, "accessors"));
        }
    if (!skinned.empty())
        facts.notices.push_back(
            file.string() + ": " + place_of(skinned) +
            ": the joints of a skin do not count, so it stands as it was modelled; apply the armature in the "
            "modeller if it should stand otherwise");
    if (!posed.empty())
        facts.notices.push_back(file.string() + ": " + place_of(posed) +
                                ": a node's own weights of morph targets do not count, those of its mesh do");
    return facts;
}

}  // namespace spawnfield
