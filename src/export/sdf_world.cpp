#include "export/text.h"

#include <spawnfield/error.h>

#include <tinyxml2.h>

#include <set>

namespace spawnfield {
namespace {

using tinyxml2::XMLElement;

void add_text(XMLElement& parent, const char* name, const std::string& text) { parent.InsertNewChildElement(name)->SetText(text.c_str()); }

void add_robot(XMLElement& world, const RobotStart& robot, const std::string& uri)
{
    XMLElement& include = *world.InsertNewChildElement("include");
    add_text(include, "uri", uri);
    add_text(include, "name", robot.name);
    add_text(include, "pose", spaced(robot));
}

const char* attribute_of(const XMLElement& element, const char* name)
{
    const char* const value = element.Attribute(name);
    return value == nullptr ? "" : value;
}

/// Names in the world's own scope: of models, lights and the like, and those that includes are given.
std::set<std::string> names_in(const XMLElement& world)
{
    std::set<std::string> names;
    for (const XMLElement* child = world.FirstChildElement(); child != nullptr; child = child->NextSiblingElement()) {
        const XMLElement* const given = child->FirstChildElement("name");
        const bool is_include = std::string_view(child->Name()) == "include";
        const char* const name = !is_include ? attribute_of(*child, "name") : given != nullptr ? given->GetText() : nullptr;
        if (name != nullptr && *name != '\0') names.insert(name);
    }
    return names;
}

/// The one world of the file, or the one that is asked for by its name.
XMLElement& find_world(XMLElement& sdf, const SdfWorldOptions& options)
{
    XMLElement* found = nullptr;
    std::string names;
    int count = 0;
    for (XMLElement* world = sdf.FirstChildElement("world"); world != nullptr; world = world->NextSiblingElement("world")) {
        const std::string name = attribute_of(*world, "name");
        names += (names.empty() ? "\"" : ", \"") + name + "\"";
        if (!options.world_name.empty() && name != options.world_name) continue;
        found = world;
        ++count;
    }
    if (names.empty()) throw FileError(options.world_file, "<sdf> has no <world>, needs one");
    if (found == nullptr) throw FileError(options.world_file, "has no world \"" + options.world_name + "\", only " + names);
    if (count > 1) throw FileError(options.world_file, "has several worlds, " + names + ": choose one by its name");
    return *found;
}

void fill(tinyxml2::XMLDocument& document, std::span<const RobotStart> robots, const SdfWorldOptions& options)
{
    if (document.Parse(options.world_text.data(), options.world_text.size()) != tinyxml2::XML_SUCCESS)
        throw FileError(options.world_file, "line " + std::to_string(document.ErrorLineNum()) + ": is no valid XML (" + document.ErrorName() + ")");
    XMLElement* const sdf = document.FirstChildElement("sdf");
    if (sdf == nullptr) throw FileError(options.world_file, "has no <sdf> as its outermost element, needs an SDF world");
    XMLElement& world = find_world(*sdf, options);
    const std::set<std::string> taken = names_in(world);
    for (const RobotStart& robot : robots) {
        if (taken.contains(robot.name))
            throw FileError(options.world_file, "line " + std::to_string(world.GetLineNum()) + ": <world> has a \"" + robot.name + "\" already; give the robots other names");
        add_robot(world, robot, options.uri);
    }
}

std::string printed(const tinyxml2::XMLDocument& document)
{
    tinyxml2::XMLPrinter printer;
    document.Print(&printer);
    return printer.CStr();
}

}  // namespace

std::string sdf_world(std::span<const RobotStart> robots, const SdfWorldOptions& options)
{
    if (options.uri.empty()) throw ArgumentError("sdf_world", "there is no URI of the robot's model");
    tinyxml2::XMLDocument document(true, tinyxml2::PRESERVE_WHITESPACE);
    if (!options.world_text.empty()) {
        fill(document, robots, options);
        return printed(document);
    }
    document.Parse("<?xml version=\"1.0\"?>\n<sdf version=\"1.7\"/>\n");
    XMLElement& world = *document.FirstChildElement("sdf")->InsertNewChildElement("world");
    world.SetAttribute("name", options.world_name.empty() ? "spawns" : options.world_name.c_str());
    world.InsertNewComment((" " + made_by(robots.size()) + ": m, rad, x forward, y left, z up (REP-103) ").c_str());
    for (const RobotStart& robot : robots) add_robot(world, robot, options.uri);
    return printed(document);
}

}  // namespace spawnfield
