#pragma once

#include <spawnfield/shape.h>

#include <yaml-cpp/yaml.h>

#include <filesystem>
#include <initializer_list>
#include <string>
#include <vector>

namespace spawnfield {

/// A mapping in a YAML file that knows where it stands, so that every complaint names file, place, key, value and
/// limit.
class YamlMap {
public:
    /// `place` is "" or such as `part "tank"`. Throws FileError unless node is a mapping without repeated keys.
    YamlMap(const YAML::Node& node, std::string file, std::string place);

    bool has(const std::string& key) const { return node_[key].IsDefined(); }
    bool is_list(const std::string& key) const { return node_[key].IsSequence(); }
    /// Throws FileError at the first key that is not one of `known`.
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
    Vec3 vector(const std::string& key) const;                 ///< three finite numbers
    Vec3 positive_vector(const std::string& key) const;        ///< three finite numbers > 0
    std::array<double, 2> pair(const std::string& key) const;  ///< two finite numbers
    std::array<double, 2> positive_pair(const std::string& key) const;
    Vec3 scale() const;                                       ///< `scale`: one number or three, > 0; 1 where absent
    std::vector<Vec3> vectors(const std::string& key) const;  ///< a list of three finite numbers each
    YamlMap map(const std::string& key) const;                ///< its complaints name "key."
    YAML::Node list(const std::string& key) const;            ///< throws FileError unless a sequence
    Pose pose() const;                                        ///< xyz with rpy or rpy_deg; identity where absent

    /// "file: place: key <what>", with the line where the key stands.
    [[noreturn]] void fail(const std::string& key, const std::string& what) const;
    [[noreturn]] void fail(const std::string& what) const;
    const std::string& file() const { return file_; }
    const std::string& place() const { return place_; }

private:
    std::vector<double> numbers(const YAML::Node& values, const std::string& key, std::size_t count) const;
    double number_in(const YAML::Node& node, const std::string& key) const;

    YAML::Node node_;
    std::string file_, place_, prefix_;
};

/// The root mapping of a YAML file. Throws FileError for a file that is missing or malformed.
YamlMap read_yaml(const std::filesystem::path& file);

/// The same of one whose `format` is as given. Throws FileError for a file that is missing or malformed.
YamlMap read_yaml(const std::filesystem::path& file, const std::string& format);

/// Exactly one of the keys that the map has; throws FileError if none or several. If none, a key that is neither of
/// them nor one of `others` is told instead: it is the misspelt one.
std::string only_key(const YamlMap& map, std::initializer_list<const char*> keys,
                     std::initializer_list<const char*> others);

/// Shape of a `box:`, `sphere:`, `cylinder:` or `capsule:` key, with the map's pose.
Shape read_shape(const YamlMap& map, const std::string& key);

}  // namespace spawnfield
