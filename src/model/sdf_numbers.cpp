#include "model/sdf_numbers.h"

#include "base/number.h"

#include <spawnfield/error.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <sstream>

namespace spawnfield {
namespace {

namespace fs = std::filesystem;

/// Numbers that a shape needs (SDFormat specification, <geometry>).
struct ShapeNumbers {
    const char* shape;
    const char* element;
    std::size_t count;
    bool is_needed = true;  ///< libsdformat would use 1 m if it is missing
};

constexpr std::array<ShapeNumbers, 14> shape_numbers{{{"box", "size", 3},
                                                      {"sphere", "radius", 1},
                                                      {"cylinder", "radius", 1},
                                                      {"cylinder", "length", 1},
                                                      {"capsule", "radius", 1},
                                                      {"capsule", "length", 1},
                                                      {"ellipsoid", "radii", 3},
                                                      {"heightmap", "size", 3},
                                                      {"heightmap", "pos", 3, false},
                                                      {"mesh", "scale", 3, false},
                                                      {"plane", "normal", 3, false},
                                                      {"plane", "size", 2, false},
                                                      {"polyline", "point", 2},
                                                      {"polyline", "height", 1}}};

void check_element(const fs::path& file, const Xml& element, std::size_t count)
{
    const std::string text = element.GetText() != nullptr ? element.GetText() : "";
    const std::string place = file.string() + ": " + line_of(element) + "<" + element.Parent()->ToElement()->Name() +
                              "> <" + element.Name() + ">";
    std::istringstream words(text);
    std::size_t found = 0;
    for (std::string word; words >> word; ++found) {
        double value = 0;
        if (!parse_number(word, value) || !std::isfinite(value))
            throw FileError(place, "\"" + word + "\" is not a finite number");
    }
    if (found != count)
        throw FileError(place, "has " + std::to_string(found) + " numbers, needs " + std::to_string(count));
}

bool is_empty(const Xml& element) { return element.NoChildren(); }

void check_pose(const fs::path& file, const Xml& pose)
{
    if (is_empty(pose)) return;  // the same as a missing pose
    const char* const format = pose.Attribute("rotation_format");
    check_element(file, pose, format != nullptr && std::string(format) == "quat_xyzw" ? 7 : 6);
}

}  // namespace

void check_numbers(const fs::path& file, const Xml& root)
{
    constexpr std::array placed{"model", "link", "collision", "include", "frame", "joint"};
    for_each_element(root, [&](const Xml& element) {
        const std::string name = element.Name();
        if (std::find(placed.begin(), placed.end(), name) != placed.end())
            for_each_child(element, "pose", [&](const Xml& pose) { check_pose(file, pose); });
        if (name != "collision") return;
        for_each_child(element, "geometry", [&](const Xml& geometry) {
            for (const ShapeNumbers& numbers : shape_numbers)
                for_each_child(geometry, numbers.shape, [&](const Xml& shape) {
                    if (numbers.is_needed && shape.FirstChildElement(numbers.element) == nullptr)
                        throw FileError(file.string() + ": " + line_of(shape) + "<" + numbers.shape + ">",
                                        "has no <" + std::string(numbers.element) + ">");
                    for_each_child(shape, numbers.element,
                                   [&](const Xml& child) { check_element(file, child, numbers.count); });
                });
        });
    });
}

}  // namespace spawnfield
