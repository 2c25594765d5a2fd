#include "base/text.h"
#include "base/xml.h"
#include "model/sdf_includes.h"
#include "simulators/text.h"

#include <spawnfield/error.h>

#include <algorithm>
#include <set>
#include <sstream>

namespace spawnfield {
namespace {

namespace fs = std::filesystem;
using tinyxml2::XMLElement;

void add_text(XMLElement& parent, const char* name, const std::string& text)
{
    parent.InsertNewChildElement(name)->SetText(text.c_str());
}

/// Returns the URI of a robot's own model, or of that of all robots.
const std::string& uri_of(const RobotStart& robot, const SdfWorldOptions& options)
{
    return robot.model.empty() ? options.uri : robot.model;
}

void add_robot(XMLElement& world, const RobotStart& robot, const SdfWorldOptions& options)
{
    XMLElement& include = *world.InsertNewChildElement("include");
    add_text(include, "uri", uri_of(robot, options));
    add_text(include, "name", robot.name);
    add_text(include, "pose", spaced(robot));
}

/// Returns the name of the model that an <include> without <name> adds; empty if the model is not found.
std::string name_of_included(const XMLElement& include, const SdfWorldOptions& options, ModelPaths& paths)
{
    const fs::path file = included_file(text_of(include, "uri"), fs::path(options.world_file).parent_path(), paths);
    if (file.empty()) return "";
    const auto document = read_xml(file, "a model");
    const XMLElement* const model = document->RootElement()->FirstChildElement("model");
    return attribute_of(model != nullptr ? *model : *document->RootElement(), "name");  // a URDF's root is the robot
}

/// Returns the names in the world's own scope: those of its models, lights and other elements, and those of included
/// models.
std::set<std::string> names_in(const XMLElement& world, const SdfWorldOptions& options)
{
    ModelPaths paths(options.model_paths, options.world_file);
    std::set<std::string> names;
    for (const XMLElement* child = world.FirstChildElement(); child != nullptr; child = child->NextSiblingElement()) {
        const XMLElement* const given = child->FirstChildElement("name");
        const bool is_include = std::string_view(child->Name()) == "include";
        const std::string name = !is_include        ? attribute_of(*child, "name")
                                 : given != nullptr ? text_of(*child, "name")
                                                    : name_of_included(*child, options, paths);
        if (!name.empty()) names.insert(name);
    }
    return names;
}

std::string printed(const tinyxml2::XMLDocument& document)
{
    tinyxml2::XMLPrinter printer;
    document.Print(&printer);
    return printer.CStr();
}

/// A world in a file, and its index among the file's worlds.
struct FoundWorld {
    XMLElement* element = nullptr;
    int index = 0;
};

/// Returns the only world of the file, or the one that has the wanted name. Throws FileError if there is none or
/// several.
FoundWorld find_world(XMLElement& sdf, const SdfWorldOptions& options)
{
    FoundWorld found;
    std::string names;
    int index = 0, count = 0;
    for (XMLElement* world = sdf.FirstChildElement("world"); world != nullptr;
         world = world->NextSiblingElement("world"), ++index) {
        const std::string name = attribute_of(*world, "name");
        names += (names.empty() ? "\"" : ", \"") + name + "\"";
        if (!options.world_name.empty() && name != options.world_name) continue;
        found = {world, index};
        ++count;
    }
    if (names.empty()) throw FileError(options.world_file, "<sdf> has no <world>, needs one");
    if (count == 0) throw FileError(options.world_file, "has no world \"" + options.world_name + "\", only " + names);
    if (count > 1) throw FileError(options.world_file, "has several worlds, " + names + ": choose one by its name");
    return found;
}

FoundWorld parse_world(tinyxml2::XMLDocument& document, const std::string& text, const SdfWorldOptions& options)
{
    if (document.Parse(text.data(), text.size()) != tinyxml2::XML_SUCCESS)
        throw FileError(options.world_file, "line " + std::to_string(document.ErrorLineNum()) + ": is not valid XML (" +
                                                document.ErrorName() + ")");
    XMLElement* const sdf = document.FirstChildElement("sdf");
    if (sdf == nullptr)
        throw FileError(options.world_file, "has no <sdf> as its outermost element, needs an SDF world");
    return find_world(*sdf, options);
}

bool is_tag(std::string_view text, std::string_view start)
{
    return text.starts_with(start) && text.size() > start.size() &&
           std::string_view(" \t\r\n/>").find(text[start.size()]) != std::string_view::npos;
}

/// Returns the position of the end tag of a world. `index` is the world's index among the worlds of the file. The XML
/// must be valid. Returns npos if the world has no end tag (<world/>).
std::size_t end_of_world(std::string_view text, int index)
{
    int depth = 0, number = -1;
    for (std::size_t place = text.find('<'); place != std::string_view::npos; place = text.find('<', place + 1)) {
        const std::string_view rest = text.substr(place);
        if (rest.starts_with("<!--"))
            place = text.find("-->", place);
        else if (rest.starts_with("<![CDATA["))
            place = text.find("]]>", place);
        else if (is_tag(rest, "</world") && --depth == 0 && number == index)
            return place;
        else if (is_tag(rest, "<world")) {
            if (depth == 0) ++number;
            place = text.find('>', place);
            if (place != std::string_view::npos && text[place - 1] != '/') ++depth;
        }
        if (place == std::string_view::npos) return place;
    }
    return std::string_view::npos;
}

/// Returns the file's own text with the robots before the world's end tag, indented like that tag; empty if the world
/// has no end tag.
std::string inserted(std::span<const RobotStart> robots, const SdfWorldOptions& options, int index)
{
    const std::string& text = options.world_text;
    const std::size_t end = end_of_world(text, index);
    if (end == std::string::npos) return "";
    const std::size_t line = text.find_last_of('\n', end) + 1;  // 0 if there is none
    const bool is_alone = text.find_first_not_of(" \t", line) == end;
    const std::string margin = is_alone ? text.substr(line, end - line) : "";
    std::string out = text.substr(0, is_alone ? line : end) + (is_alone ? "" : "\n");
    const auto add_line = [&](const std::string& content) { out += margin + content + "\n"; };
    for (const RobotStart& robot : robots) {
        add_line("  <include>");
        add_line("    <uri>" + xml_escaped(uri_of(robot, options)) + "</uri>");
        add_line("    <name>" + xml_escaped(robot.name) + "</name>");
        add_line("    <pose>" + spaced(robot) + "</pose>");
        add_line("  </include>");
    }
    return out + text.substr(is_alone ? line : end);
}

/// Returns the world file with the robots. If possible, every other character of the file stays as it is; otherwise the
/// whole XML document is printed anew.
std::string filled(std::span<const RobotStart> robots, const SdfWorldOptions& options)
{
    tinyxml2::XMLDocument document;
    const FoundWorld found = parse_world(document, options.world_text, options);
    std::set<std::string> taken = names_in(*found.element, options);
    for (const RobotStart& robot : robots)
        if (!taken.insert(robot.name).second)
            throw FileError(options.world_file, "line " + std::to_string(found.element->GetLineNum()) +
                                                    ": <world> has a \"" + robot.name +
                                                    "\" already; give the robots other names");
    for (const RobotStart& robot : robots) add_robot(*found.element, robot, options);
    const std::string text = inserted(robots, options, found.index);
    tinyxml2::XMLDocument again;
    if (!text.empty() &&
        names_in(*parse_world(again, text, options).element, options) == names_in(*found.element, options))
        return text;
    return printed(document);
}

}  // namespace

std::string sdf_world(std::span<const RobotStart> robots, const SdfWorldOptions& options)
{
    const bool have_models = std::ranges::none_of(robots, [](const RobotStart& robot) { return robot.model.empty(); });
    if (options.uri.empty() && (robots.empty() || !have_models))
        throw ArgumentError("sdf_world", "needs the URI of the robot's model");
    if (!options.world_text.empty()) return filled(robots, options);
    tinyxml2::XMLDocument document;
    document.Parse("<?xml version=\"1.0\"?>\n<sdf version=\"1.7\"/>\n");
    XMLElement& world = *document.FirstChildElement("sdf")->InsertNewChildElement("world");
    world.SetAttribute("name", options.world_name.empty() ? "spawns" : options.world_name.c_str());
    world.InsertNewComment((" " + made_by(robots.size()) + ": m, rad, x forward, y left, z up (REP-103) ").c_str());
    for (const RobotStart& robot : robots) add_robot(world, robot, options);
    return printed(document);
}

ModelPlacement model_placement(const fs::path& path)
{
    const fs::path file = model_file_of(path);
    if (lower_case(file.extension().string()) != ".sdf") return {};
    const auto document = read_sdf_xml(file);
    const XMLElement* const model = document->RootElement()->FirstChildElement("model");
    if (model == nullptr) return {};
    std::istringstream numbers(text_of(*model, "pose"));
    bool has_pose = false;
    for (double value = 0; numbers >> value;) has_pose = has_pose || value != 0;
    return {attribute_of(*model, "placement_frame"), has_pose};
}

}  // namespace spawnfield
