#include "sdf_world.h"

#include <spawnfield/types.h>

#include <tinyxml2.h>

#include <Eigen/Geometry>
#include <sstream>

using namespace spawnfield;
using Xml = tinyxml2::XMLElement;

namespace {

std::string text_of(const Xml* parent, const char* name)
{
    const Xml* const child = parent->FirstChildElement(name);
    return child != nullptr && child->GetText() != nullptr ? child->GetText() : "";
}

std::vector<double> numbers_of(const std::string& text)
{
    std::istringstream stream(text);
    return {std::istream_iterator<double>(stream), {}};
}

std::string list(const std::vector<double>& values)
{
    std::ostringstream text;
    text.precision(17);
    for (std::size_t i = 0; i < values.size(); ++i) text << (i == 0 ? "[" : ", ") << values[i];
    return text.str() + "]";
}

Eigen::Isometry3d pose_of(const Xml* element)
{
    std::vector<double> pose = numbers_of(text_of(element, "pose"));
    pose.resize(6);
    Eigen::Isometry3d out = Eigen::Isometry3d::Identity();
    out.linear() = rotation_from_rpy(pose[3], pose[4], pose[5]);
    out.translation() = Vec3(pose[0], pose[1], pose[2]);
    return out;
}

/// Returns a wall around the points, with a lid and a floor that are fans of triangles. Each edge has two faces.
std::string prism_obj(const Xml* polyline)
{
    std::string points, faces;
    std::size_t count = 0;
    const std::string height = text_of(polyline, "height");
    for (const Xml* point = polyline->FirstChildElement("point"); point != nullptr;
         point = point->NextSiblingElement("point"), ++count)
        points += "v " + std::string(point->GetText()) + " 0\nv " + point->GetText() + " " + height + "\n";
    const auto low = [&](std::size_t i) { return std::to_string(2 * (i % count) + 1) + " "; };
    const auto high = [&](std::size_t i) { return std::to_string(2 * (i % count) + 2) + " "; };
    for (std::size_t i = 0; i < count; ++i)
        faces += "f " + low(i) + low(i + 1) + high(i + 1) + "\nf " + low(i) + high(i + 1) + high(i) + "\n";
    for (std::size_t i = 1; i + 1 < count; ++i)
        faces += "f " + high(0) + high(i) + high(i + 1) + "\nf " + low(0) + low(i + 1) + low(i) + "\n";
    return points + faces;
}

class WorldReader {
public:
    WorldReader(const TempFolder& folder, std::filesystem::path models) : folder_(folder), models_(std::move(models)) {}

    /// Adds everything in a world or a model; `names` are the names of the models around it.
    void add_children(const Xml* parent, const Eigen::Isometry3d& frame, const std::string& names)
    {
        for (const Xml* child = parent->FirstChildElement(); child != nullptr; child = child->NextSiblingElement()) {
            const std::string kind = child->Name();
            if (kind == "include") add_include(child, frame, names);
            if (kind == "model") add_children(child, frame * pose_of(child), names + child->Attribute("name") + "/");
            if (kind == "link") add_link(child, frame * pose_of(child), names);
        }
    }

    void add_file(const std::filesystem::path& file)
    {
        tinyxml2::XMLDocument document;
        if (document.LoadFile(file.c_str()) != tinyxml2::XML_SUCCESS)
            throw std::runtime_error("cannot read " + file.string());
        add_children(document.FirstChildElement("sdf")->FirstChildElement("world"), Eigen::Isometry3d::Identity(), "");
    }

    const std::string& parts() const { return parts_; }

private:
    std::filesystem::path resolved(const std::string& uri) const
    {
        const std::string scheme = "model://";
        return uri.starts_with(scheme) ? models_ / uri.substr(scheme.size()) : std::filesystem::path();
    }

    void add_include(const Xml* include, const Eigen::Isometry3d& frame, const std::string& names)
    {
        const std::string uri = text_of(include, "uri");
        tinyxml2::XMLDocument document;
        if (document.LoadFile((resolved(uri) / "model.sdf").c_str()) != tinyxml2::XML_SUCCESS) return;
        const Xml* const model = document.FirstChildElement("sdf")->FirstChildElement("model");
        const Xml* const posed = include->FirstChildElement("pose") != nullptr ? include : model;
        add_children(model, frame * pose_of(posed), names + uri + "/");
    }

    void add_link(const Xml* link, const Eigen::Isometry3d& frame, const std::string& names)
    {
        for (const Xml* collision = link->FirstChildElement("collision"); collision != nullptr;
             collision = collision->NextSiblingElement("collision"))
            if (const Xml* const shape = collision->FirstChildElement("geometry")->FirstChildElement())
                add_part(shape_line(shape), frame * pose_of(collision), names);
    }

    std::string shape_line(const Xml* shape)
    {
        const std::string kind = shape->Name();
        if (kind == "box") return "box: " + list(numbers_of(text_of(shape, "size")));
        if (kind == "plane") return "plane: " + list(numbers_of(text_of(shape, "size")));
        if (kind == "sphere") return "sphere: " + text_of(shape, "radius");
        if (kind == "cylinder")
            return "cylinder: {radius: " + text_of(shape, "radius") + ", length: " + text_of(shape, "length") + "}";
        if (kind == "polyline")
            return "mesh: " + folder_.write("pavement" + std::to_string(count_) + ".obj", prism_obj(shape)).string();
        const std::filesystem::path file = resolved(text_of(shape, "uri"));
        if (kind != "mesh" || !std::filesystem::is_regular_file(file)) return "";
        const std::vector<double> scale = numbers_of(text_of(shape, "scale"));
        return "mesh: " + file.string() + (scale.empty() ? "" : ", scale: " + list(scale));
    }

    void add_part(const std::string& shape, const Eigen::Isometry3d& pose, const std::string& names)
    {
        if (shape.empty()) return;
        bool ground = shape.starts_with("plane");
        for (const char* const word : {"Ground", "sidewalk", "bridge", "pier", "parking_garage", "asphalt"})
            ground |= names.find(word) != names.npos;
        const Mat3 r = pose.linear();
        const Vec3 position = pose.translation();
        parts_ += "  - {name: p" + std::to_string(count_++) + ", label: " + (ground ? "terrain" : "obstacle") + ", " +
                  shape + ", xyz: " + list({position.x(), position.y(), position.z()}) + ", rpy: " +
                  list({std::atan2(r(2, 1), r(2, 2)), -std::asin(std::clamp(r(2, 0), -1.0, 1.0)),
                        std::atan2(r(1, 0), r(0, 0))}) +
                  "}\n";
    }

    const TempFolder& folder_;
    std::filesystem::path models_;
    std::string parts_;
    std::size_t count_ = 0;
};

}  // namespace

std::filesystem::path scene_of_world(const TempFolder& folder, const std::filesystem::path& world,
                                     const std::filesystem::path& models)
{
    WorldReader reader(folder, models);
    reader.add_file(world);
    return folder.write("scene.yaml", "format: spawnfield-scene/1\nname: world\nparts:\n" + reader.parts());
}
