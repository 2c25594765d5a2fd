#include "base/yaml_map.h"

#include "base/number.h"

#include <spawnfield/error.h>
#include <spawnfield/input_file.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <set>

namespace spawnfield {
namespace {

std::string scalar_of(const YAML::Node& node)
{
    if (node.IsScalar()) return node.Scalar();
    return node.IsMap() ? "a mapping" : node.IsSequence() ? "a list" : "empty";
}

}  // namespace

YamlMap::YamlMap(const YAML::Node& node, std::string file, std::string place)
    : node_(node), file_(std::move(file)), place_(std::move(place))
{
    if (!node_.IsMap()) fail("is " + scalar_of(node_) + ", needs a mapping (key: value)");
    std::set<std::string> seen;
    for (const auto& entry : node_)
        if (!seen.insert(scalar_of(entry.first)).second) fail(scalar_of(entry.first), "is given twice");
}

void YamlMap::only(const std::vector<std::string>& known) const
{
    for (const auto& entry : node_) {
        const std::string key = scalar_of(entry.first);
        if (std::find(known.begin(), known.end(), key) != known.end()) continue;
        std::string names;
        for (const std::string& name : known) names += (names.empty() ? "" : ", ") + name;
        fail(key, "is not a known key; known keys: " + names);
    }
}

std::vector<std::string> YamlMap::keys() const
{
    std::vector<std::string> out;
    for (const auto& entry : node_) out.push_back(scalar_of(entry.first));
    return out;
}

std::string YamlMap::text(const std::string& key) const
{
    if (!has(key)) fail(key, "is missing");
    if (!node_[key].IsScalar() || node_[key].Scalar().empty())
        fail(key, "is " + scalar_of(node_[key]) + ", needs text");
    return node_[key].Scalar();
}

std::string YamlMap::one_of(const std::string& key, std::initializer_list<const char*> values,
                            const std::string& fallback) const
{
    const std::string value = text(key, fallback);
    if (std::find(values.begin(), values.end(), value) != values.end()) return value;
    std::string names;
    for (const char* name : values) names += (names.empty() ? "" : ", ") + std::string(name);
    fail(key, "is \"" + value + "\", needs one of " + names);
}

double YamlMap::number_in(const YAML::Node& node, const std::string& key) const
{
    double value = 0;
    const std::string text = scalar_of(node);
    // yaml-cpp decodes YAML's own spellings of numbers that are not finite (.inf, .nan).
    const bool is_number = node.IsScalar() && (parse_number(text, value) || YAML::convert<double>::decode(node, value));
    if (!is_number) fail(key, "is \"" + text + "\", needs a number");
    if (!std::isfinite(value)) fail(key, "is " + text + ", needs a finite number");
    return value;
}

double YamlMap::finite(const std::string& key) const
{
    if (!has(key)) fail(key, "is missing");
    return number_in(node_[key], key);
}

double YamlMap::positive(const std::string& key) const
{
    const double value = finite(key);
    if (!(value > 0)) fail(key, "is " + number(value) + ", needs > 0");
    return value;
}

std::int64_t YamlMap::whole(const std::string& key, double low, double high) const
{
    const double value = finite(key);
    if (value != std::floor(value) || value < low || value > high)
        fail(key, "is " + number(value) + ", needs a whole number from " + number(low) + " to " + number(high));
    return std::int64_t(value);
}

std::vector<double> YamlMap::numbers(const YAML::Node& values, const std::string& key, std::size_t count) const
{
    if (!values.IsSequence()) fail(key, "is " + scalar_of(values) + ", needs a list");
    if (values.size() != count)
        fail(key, "has " + std::to_string(values.size()) + " numbers, needs " + std::to_string(count));
    std::vector<double> out;
    for (const auto& value : values) out.push_back(number_in(value, key));
    return out;
}

Vec3 YamlMap::vector(const std::string& key) const
{
    const auto values = numbers(list(key), key, 3);
    return {values[0], values[1], values[2]};
}

Vec3 YamlMap::positive_vector(const std::string& key) const
{
    const Vec3 value = vector(key);
    for (const double x : value)
        if (!(x > 0)) fail(key, "has " + number(x) + ", needs > 0");
    return value;
}

std::array<double, 2> YamlMap::pair(const std::string& key) const
{
    const auto values = numbers(list(key), key, 2);
    return {values[0], values[1]};
}

std::array<double, 2> YamlMap::positive_pair(const std::string& key) const
{
    const auto value = pair(key);
    for (const double x : value)
        if (!(x > 0)) fail(key, "has " + number(x) + ", needs > 0");
    return value;
}

Vec3 YamlMap::scale() const
{
    if (!has("scale")) return Vec3::Ones();
    return is_list("scale") ? positive_vector("scale") : Vec3(Vec3::Constant(positive("scale")));
}

std::vector<Vec3> YamlMap::vectors(const std::string& key) const
{
    std::vector<Vec3> out;
    for (const YAML::Node& node : list(key)) {
        const auto values = numbers(node, key, 3);
        out.emplace_back(values[0], values[1], values[2]);
    }
    return out;
}

YamlMap YamlMap::map(const std::string& key) const
{
    if (!has(key)) fail(key, "is missing");
    if (!node_[key].IsMap()) fail(key, "is " + scalar_of(node_[key]) + ", needs a mapping (key: value)");
    YamlMap inner(node_[key], file_, place_);
    inner.prefix_ = prefix_ + key + ".";
    return inner;
}

YAML::Node YamlMap::list(const std::string& key) const
{
    if (!has(key)) fail(key, "is missing");
    if (!node_[key].IsSequence()) fail(key, "is " + scalar_of(node_[key]) + ", needs a list");
    return node_[key];
}

Pose YamlMap::pose() const
{
    Pose pose;
    if (has("xyz")) pose.position = vector("xyz");
    if (has("rpy") && has("rpy_deg")) fail("rpy_deg", "is given together with rpy, needs only one of them");
    const Vec3 rpy = has("rpy")       ? vector("rpy")
                     : has("rpy_deg") ? Vec3(vector("rpy_deg") * (std::numbers::pi / 180))
                                      : Vec3(Vec3::Zero());
    pose.rotation = rotation_from_rpy(rpy.x(), rpy.y(), rpy.z());
    return pose;
}

void YamlMap::fail(const std::string& key, const std::string& what) const
{
    std::string line;
    for (const auto& entry : node_)
        if (entry.first.IsScalar() && entry.first.Scalar() == key)
            line = " (line " + std::to_string(entry.first.Mark().line + 1) + ")";
    throw FileError(file_, (place_.empty() ? "" : place_ + ": ") + prefix_ + key + " " + what + line);
}

void YamlMap::fail(const std::string& what) const
{
    const int line = node_.Mark().line;
    throw FileError(file_, (place_.empty() ? "" : place_ + ": ") + what +
                               (line >= 0 ? " (line " + std::to_string(line + 1) + ")" : ""));
}

YamlMap read_yaml(const std::filesystem::path& file)
{
    const std::string text = read_file(file);
    YAML::Node root;
    try {
        root = YAML::Load(text);
    } catch (const YAML::Exception& error) {
        throw FileError(file.string(), "line " + std::to_string(error.mark.line + 1) + ": " + error.msg);
    }
    return {root, file.string(), ""};
}

YamlMap read_yaml(const std::filesystem::path& file, const std::string& format)
{
    const YamlMap map = read_yaml(file);
    const std::string found = map.text("format");
    if (found != format) map.fail("format", "is \"" + found + "\", needs " + format);
    return map;
}

std::string only_key(const YamlMap& map, std::initializer_list<const char*> keys,
                     std::initializer_list<const char*> others)
{
    std::string found, names;
    for (const char* key : keys) {
        names += (names.empty() ? "" : ", ") + std::string(key);
        if (!map.has(key)) continue;
        if (!found.empty()) map.fail(key, "is given together with " + found + ", needs one geometry per part");
        found = key;
    }
    if (!found.empty()) return found;
    std::vector<std::string> known(keys.begin(), keys.end());
    known.insert(known.end(), others.begin(), others.end());
    map.only(known);
    map.fail("has no geometry, needs one of " + names);
}

Shape read_shape(const YamlMap& map, const std::string& key)
{
    Shape shape;
    shape.pose = map.pose();
    if (key == "box") {
        shape.kind = ShapeKind::Box;
        shape.size = map.positive_vector("box");
    } else if (key == "sphere") {
        shape.kind = ShapeKind::Sphere;
        shape.size = {map.positive("sphere"), 0, 0};
    } else {
        const YamlMap inner = map.map(key);
        inner.only({"radius", "length"});
        shape.kind = key == "cylinder" ? ShapeKind::Cylinder : ShapeKind::Capsule;
        shape.size = {inner.positive("radius"), inner.positive("length"), 0};
    }
    return shape;
}

}  // namespace spawnfield
