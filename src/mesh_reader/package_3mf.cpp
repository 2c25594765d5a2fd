#include "mesh_reader/package_3mf.h"

#include "mesh_reader/mesh_checks.h"
#include "mesh_reader/tag_text.h"
#include "mesh_reader/zip_archive.h"

#include <spawnfield/error.h>

#include <tinyxml2.h>

#include <algorithm>
#include <cstdint>
#include <map>
#include <vector>

namespace spawnfield {
namespace {

/// Returns the path of the 3D model in the package, without the leading slash; "" if there is none.
std::string model_name(const std::string& relationships)
{
    tinyxml2::XMLDocument document;
    document.Parse(relationships.c_str());
    const tinyxml2::XMLElement* const root = document.RootElement();
    for (const auto* e = root ? root->FirstChildElement() : nullptr; e != nullptr; e = e->NextSiblingElement()) {
        const char *const type = e->Attribute("Type"), *const target = e->Attribute("Target");
        if (type == nullptr || target == nullptr || !std::string_view(type).ends_with("/3dmodel")) continue;
        return target[0] == '/' ? target + 1 : target;
    }
    return {};
}

void check_unpacked_size(std::string_view package, const std::string& file)
{
    constexpr std::uint64_t megabyte = 1000000, least = 100 * megabyte, times = 50;  // text of XML is packed to 1 : 20
    const std::uint64_t unpacked = unpacked_size(package), most = std::max(least, times * package.size());
    if (unpacked > most)
        throw FileError(file, "its " + std::to_string(package.size()) + " bytes unpack to " +
                                  std::to_string(unpacked / megabyte) + " MB, needs at most " +
                                  std::to_string(most / megabyte) + " MB; is it damaged?");
}

/// An object of the 3D model: its own triangles, and the objects that it consists of.
struct Object {
    std::uint64_t triangles = 0;
    std::vector<std::string> components;
    int levels = 1;  ///< of objects, with its own
    enum class State { New, Open, Counted } state = State::New;
};
using Objects = std::map<std::string, Object>;

/// Reads the start tags of the model. This is no reader of XML: it only has to count what assimp will build.
Objects objects_of(std::string_view model)
{
    Objects objects;
    Object* open = nullptr;
    for (std::size_t tag = model.find('<'); tag != std::string_view::npos; tag = model.find('<', tag + 1)) {
        const std::size_t end = std::min(model.find('>', tag), model.size());
        const std::string_view text = model.substr(tag + 1, end - tag - 1);
        const std::string_view name = name_of_tag(text);
        const std::string_view rest = text.substr(std::size_t(name.data() - text.data()) + name.size());
        if (name == "object")
            open = &objects[attribute(rest, "id")];
        else if (name == "triangle" && open != nullptr)
            ++open->triangles;
        else if (name == "component" && open != nullptr)
            open->components.push_back(attribute(rest, "objectid"));
    }
    return objects;
}

/// Counts the triangles and the levels of an object with all its components. `depth`: how many objects contain it on
/// the way here.
const Object& count(Objects& objects, const std::string& id, int depth, const std::string& file)
{
    constexpr int deepest = 1000;
    const auto too_deep = [&] {
        return FileError(file, "its components are nested more than " + std::to_string(deepest) + " deep; merge them");
    };
    const auto found = objects.find(id);
    if (found == objects.end()) throw FileError(file, "a component is object \"" + id + "\", which does not exist");
    Object& object = found->second;
    if (object.state == Object::State::Open) throw FileError(file, "object \"" + id + "\" contains itself");
    if (object.state == Object::State::Counted) return object;
    if (depth >= deepest) throw too_deep();
    object.state = Object::State::Open;
    for (const std::string& component : object.components) {
        const Object& inner = count(objects, component, depth + 1, file);
        object.triangles += inner.triangles;
        object.levels = std::max(object.levels, inner.levels + 1);
        if (object.triangles > most_triangles)
            throw FileError(file, "its components repeat triangles to more than " + std::to_string(most_triangles) +
                                      ", needs fewer; remove components");
    }
    if (object.levels > deepest) throw too_deep();
    object.state = Object::State::Counted;
    return object;
}

}  // namespace

void check_3mf(std::string_view package, const std::string& file)
{
    check_unpacked_size(package, file);
    const std::string model = model_of_3mf(package, std::string_view::npos);
    if (model.empty()) throw FileError(file, "has no 3D model at the path that its _rels/.rels names; export it again");
    Objects objects = objects_of(model);
    for (const auto& [id, object] : objects) count(objects, id, 0, file);
}

std::string model_of_3mf(std::string_view package, std::size_t most)
{
    constexpr std::size_t most_relationships = 1 << 20;  // bytes
    const std::string name = model_name(file_in_zip(package, "_rels/.rels", most_relationships));
    return name.empty() ? "" : file_in_zip(package, name, most);
}

}  // namespace spawnfield
