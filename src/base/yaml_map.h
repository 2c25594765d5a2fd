#pragma once

#include <spawnfield/shape.h>

#include <yaml-cpp/yaml.h>

#include <cstdint>
#include <filesystem>
#include <initializer_list>
#include <string>
#include <vector>

namespace spawnfield {

/// A mapping in a YAML file. It knows its place, so that each error names the file, the place, the key, the value and
/// the limit. All functions that read a value throw FileError if it is missing or wrong.
class YamlMap {
public:
    /// `place` is "" or, for example, `part "tank"`. Throws FileError unless `node` is a mapping without repeated keys.
    YamlMap(const YAML::Node& node, std::string file, std::string place);

    bool has(const std::string& key) const { return node_[key].IsDefined(); }
    bool is_list(const std::string& key) const { return node_[key].IsSequence(); }
    /// Throws FileError for the first key that is not in `known`.
    void only(const std::vector<std::string>& known) const;

    std::vector<std::string> keys() const;  ///< in the file's order
    std::string text(const std::string& key) const;
    std::string text(const std::string& key, const std::string& fallback) const
    {
        return has(key) ? text(key) : fallback;
    }
    std::string one_of(const std::string& key, std::initializer_list<const char*> values,
                       const std::string& fallback) const;
    double positive(const std::string& key) const;  ///< finite, > 0
    double finite(const std::string& key) const;
    std::int64_t whole(const std::string& key, double low, double high) const;  ///< from low to high, at most 2^53
    Vec3 vector(const std::string& key) const;                                  ///< three finite numbers
    Vec3 positive_vector(const std::string& key) const;                         ///< three finite numbers > 0
    std::array<double, 2> pair(const std::string& key) const;                   ///< two finite numbers
    std::array<double, 2> positive_pair(const std::string& key) const;
    Vec3 scale() const;                                       ///< `scale`: one number or three, > 0; 1 if it is missing
    std::vector<Vec3> vectors(const std::string& key) const;  ///< a list of three finite numbers each
    YamlMap map(const std::string& key) const;                ///< its errors name the keys as "key.inner"
    YAML::Node list(const std::string& key) const;            ///< throws FileError unless it is a list
    Pose pose() const;                                        ///< from xyz and rpy or rpy_deg; a missing key means 0

    /// Throws FileError "file: place: key <what>", with the line of the key.
    [[noreturn]] void fail(const std::string& key, const std::string& what) const;
    /// Throws FileError "file: place: <what>", with the line of the mapping.
    [[noreturn]] void fail(const std::string& what) const;
    const std::string& file() const { return file_; }
    const std::string& place() const { return place_; }

private:
    std::vector<double> numbers(const YAML::Node& values, const std::string& key, std::size_t count) const;
    double number_in(const YAML::Node& node, const std::string& key) const;

    YAML::Node node_;
    std::string file_, place_, prefix_;
};

/// Returns the root mapping of a YAML file. Throws FileError if the file is missing or malformed.
YamlMap read_yaml(const std::filesystem::path& file);

/// Does the same, but also throws FileError unless the key `format` has the given value.
YamlMap read_yaml(const std::filesystem::path& file, const std::string& format);

/// Returns the one of `keys` that the map has. Throws FileError if it has none or several. If it has none, the error
/// names a key that is neither in `keys` nor in `others`, if there is one, because that key is probably misspelt.
std::string only_key(const YamlMap& map, std::initializer_list<const char*> keys,
                     std::initializer_list<const char*> others);

/// Reads the shape of a `box:`, `sphere:`, `cylinder:` or `capsule:` key, with the pose of the map.
Shape read_shape(const YamlMap& map, const std::string& key);

}  // namespace spawnfield
