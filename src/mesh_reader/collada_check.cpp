#include "mesh_reader/collada_check.h"

#include "base/number.h"
#include "base/text.h"
#include "base/xml.h"
#include "mesh_reader/collada_numbers.h"

#include <spawnfield/error.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <cstdint>
#include <sstream>
#include <unordered_map>

namespace spawnfield {
namespace {

constexpr std::uint64_t most_nodes = 1000000;
constexpr int most_depth = 500;

/// Counts the nodes of the scene as if each <instance_node> were replaced by the node that it names.
class NodeCheck {
public:
    NodeCheck(const Xml& collada, const std::string& file) : file_(file)
    {
        for (const Xml* library = collada.FirstChildElement("library_nodes"); library != nullptr;
             library = library->NextSiblingElement("library_nodes"))
            for (const Xml* node = library->FirstChildElement("node"); node != nullptr;
                 node = node->NextSiblingElement("node"))
                library_[attribute_of(*node, "id")] = node;
        for (const Xml* library = collada.FirstChildElement("library_visual_scenes"); library != nullptr;
             library = library->NextSiblingElement("library_visual_scenes"))
            for (const Xml* scene = library->FirstChildElement("visual_scene"); scene != nullptr;
                 scene = scene->NextSiblingElement("visual_scene"))
                scenes_["#" + attribute_of(*scene, "id")] = scene;
    }

    void visit(const Xml& collada)
    {
        const Xml* const scene = collada.FirstChildElement("scene");
        const Xml* const instance = scene == nullptr ? nullptr : scene->FirstChildElement("instance_visual_scene");
        const auto root = instance == nullptr ? scenes_.end() : scenes_.find(attribute_of(*instance, "url"));
        if (root == scenes_.end()) return;  // assimp reports this
        add_names(*root->second);
        size_of(*root->second, 1);
    }

private:
    struct Size {
        std::uint64_t nodes = 0;  ///< the node itself and all below it; 0: the count is still in progress
        int depth = 0;            ///< levels of nodes, with the node itself
    };

    FileError error_at(const Xml& node, const std::string& what) const
    {
        const std::string name = node.Attribute("name") != nullptr ? attribute_of(node, "name")
                                                                   : attribute_of(node, "id");
        return FileError(
            file_, "line " + std::to_string(node.GetLineNum()) + ": <" + node.Name() + "> \"" + name + "\" " + what);
    }

    void add_names(const Xml& node)
    {
        for (const char* attribute : {"name", "id"})
            if (node.Attribute(attribute) != nullptr) named_.try_emplace(node.Attribute(attribute), &node);
        for (const Xml* child = node.FirstChildElement("node"); child != nullptr;
             child = child->NextSiblingElement("node"))
            add_names(*child);
    }

    /// Returns the node that assimp finds for the instance: a library's node with this id, else the scene's first node
    /// with this id or name. Null if there is none.
    const Xml* target_of(const Xml& instance) const
    {
        const std::string url = attribute_of(instance, "url"), name = url.empty() ? url : url.substr(1);
        if (const auto found = library_.find(name); found != library_.end()) return found->second;
        const auto found = named_.find(name);
        return found == named_.end() ? nullptr : found->second;
    }

    Size size_of(const Xml& node, int depth)
    {
        if (depth > most_depth)
            throw error_at(node, "is nested more than " + std::to_string(most_depth) +
                                     " deep, counting <instance_node>; merge nodes");
        const auto [entry, is_new] = sizes_.try_emplace(&node);
        if (!is_new && entry->second.nodes == 0)
            throw error_at(node, "contains itself through <instance_node>; remove the circle");
        if (!is_new && depth + entry->second.depth <= most_depth) return entry->second;
        Size size{1, 1};
        for (const Xml* child = node.FirstChildElement(); child != nullptr; child = child->NextSiblingElement()) {
            if (is_named(*child, "instance_geometry") || is_named(*child, "instance_controller")) ++size.nodes;
            const Xml* const inner = is_named(*child, "node")            ? child
                                     : is_named(*child, "instance_node") ? target_of(*child)
                                                                         : nullptr;
            if (inner == nullptr) continue;
            const Size inner_size = size_of(*inner, depth + 1);
            size.nodes += inner_size.nodes;
            size.depth = std::max(size.depth, inner_size.depth + 1);
            if (size.nodes > most_nodes)
                throw error_at(
                    node,
                    "has more than " + std::to_string(most_nodes) +
                        " nodes, counting all that its <instance_node>s repeat; merge nodes, or use fewer instances");
        }
        return sizes_[&node] = size;
    }

    const std::string& file_;
    std::unordered_map<std::string, const Xml*> library_, scenes_, named_;
    std::unordered_map<const Xml*, Size> sizes_;
};

/// Returns whether assimp can read the colour: at least four numbers, or three for a light, without a space before the
/// first.
bool is_plain_color(const Xml& color)
{
    const std::string text = color.GetText() != nullptr ? color.GetText() : "";
    const Xml* const parent = color.Parent()->ToElement();
    const Xml* const above = parent == nullptr ? nullptr : parent->Parent()->ToElement();
    const std::size_t least = above != nullptr && is_named(*above, "technique_common") ? 3 : 4;
    std::istringstream words(text);
    std::size_t count = 0;
    for (std::string word; words >> word; ++count) {
        double value = 0;
        if (!parse_number(word, value) || !std::isfinite(value)) return false;
    }
    return count >= least && std::isspace(static_cast<unsigned char>(text.front())) == 0;
}

/// Replaces the colours that assimp cannot read. Returns whether there were any.
bool replace_colors(Xml& element)  // recursive: tinyxml2 limits the depth
{
    bool found = false;
    if (is_named(element, "color") && !is_plain_color(element)) {
        element.DeleteChildren();
        element.SetText("0 0 0 1");
        found = true;
    }
    for (Xml* child = element.FirstChildElement(); child != nullptr; child = child->NextSiblingElement())
        found = replace_colors(*child) || found;
    return found;
}

}  // namespace

bool is_collada(std::string_view bytes, const std::string& extension)
{
    return extension == ".dae" || bytes.substr(0, 4096).find("<COLLADA") != std::string_view::npos;
}

std::string check_collada(std::string_view bytes, const std::string& file)
{
    tinyxml2::XMLDocument document;
    const tinyxml2::XMLError error = document.Parse(bytes.data(), bytes.size());
    const std::string line = "line " + std::to_string(document.ErrorLineNum()) + ": ";
    if (error == tinyxml2::XML_ELEMENT_DEPTH_EXCEEDED)
        throw FileError(file, line + "elements are nested more than " + std::to_string(TINYXML2_MAX_ELEMENT_DEPTH) +
                                  " deep; merge nodes");
    if (error != tinyxml2::XML_SUCCESS || bytes.find('\0') != std::string_view::npos) {
        std::string name = error == tinyxml2::XML_SUCCESS ? "it contains a zero byte"
                                                          : lower_case(document.ErrorName());
        std::replace(name.begin(), name.end(), '_', ' ');
        throw FileError(file, "cannot be read as a mesh: " + line + "not valid XML (" + name + "); is it cut short?");
    }
    for (const Xml* root = document.FirstChildElement(); root != nullptr; root = root->NextSiblingElement()) {
        check_collada_numbers(*root, file);
        NodeCheck(*root, file).visit(*root);
    }
    Xml* const root = document.RootElement();
    if (root == nullptr || !replace_colors(*root)) return "";
    tinyxml2::XMLPrinter printer(nullptr, true);
    document.Print(&printer);
    return printer.CStr();
}

}  // namespace spawnfield
