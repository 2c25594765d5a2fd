#include "poses/json_poses.h"

#include "base/csv.h"
#include "base/number.h"
#include "base/text.h"

#include <spawnfield/error.h>

#include <nlohmann/json.hpp>

#include <algorithm>
#include <array>

namespace spawnfield {
namespace {

using Value = nlohmann::json;

/// The formats with poses, and the key of their list.
struct PoseFormat {
    const char *format, *list;
};
constexpr std::array pose_formats{PoseFormat{"spawnfield-spawns/1", "poses"},
                                  PoseFormat{"spawnfield-verdicts/1", "poses"},
                                  PoseFormat{"spawnfield-fleet-poses/1", "robots"}};

class JsonPoses {
public:
    explicit JsonPoses(const std::string& file) : file_(file) {}

    std::string csv(std::string_view text)
    {
        const Value root = parsed(text);
        const Value& list = list_of(root);
        for (const char* const key : {"name", "kind", "verdict"})
            if (std::ranges::any_of(list, [&](const Value& pose) { return pose.is_object() && pose.contains(key); }))
                texts_.emplace_back(key);
        std::string out = "x,y,z,roll,pitch,yaw";
        for (const std::string& key : texts_) out += ',' + key;
        out += '\n';
        for (const Value& pose : list) append(out, pose);
        return out;
    }

private:
    Value parsed(std::string_view text) const
    {
        try {
            return Value::parse(text);
        } catch (const Value::exception& error) {  // names the place
            throw FileError(file_, std::string("is not valid JSON: ") + error.what());
        }
    }

    const Value& list_of(const Value& root) const
    {
        const std::string format = root.contains("format") && root["format"].is_string() ? root["format"] : "";
        std::string known;
        for (const PoseFormat& known_format : pose_formats) {
            known += (known.empty() ? "" : ", ") + std::string(known_format.format);
            if (format != known_format.format) continue;
            const auto list = root.find(known_format.list);
            if (list == root.end() || !list->is_array())
                throw FileError(file_, std::string(known_format.list) + " is missing or no list, needs the poses");
            return *list;
        }
        throw FileError(file_, "format is \"" + format + "\", needs one with poses: " + known);
    }

    void append(std::string& out, const Value& pose)
    {
        ++number_;
        if (!pose.is_object()) fail("is not an object");
        append_numbers(out, pose, "position");
        out += ',';
        append_numbers(out, pose, "rpy");
        for (const std::string& key : texts_) {
            out += ',';
            const auto found = pose.find(key);
            if (found == pose.end()) continue;
            if (!found->is_string()) fail(key + " is not a text");
            out += csv_quoted(one_line(found->get<std::string>()));
        }
        out += '\n';
    }

    void append_numbers(std::string& out, const Value& pose, const char* key) const
    {
        const auto found = pose.find(key);
        if (found == pose.end() || !found->is_array() || found->size() != 3 ||
            !std::ranges::all_of(*found, [](const Value& value) { return value.is_number(); }))
            fail(std::string(key) + " is missing, or is not a list of three numbers");
        for (std::size_t k = 0; k < 3; ++k) {
            if (k > 0) out += ',';
            append_number(out, (*found)[k].get<double>());
        }
    }

    [[noreturn]] void fail(const std::string& what) const
    {
        throw FileError(file_, "pose " + std::to_string(number_) + ": " + what);
    }

    const std::string& file_;
    std::vector<std::string> texts_ = {};  ///< the keys of texts that a pose has
    std::size_t number_ = 0;               ///< of the pose that is read, from 1 on
};

}  // namespace

bool is_json(std::string_view text)
{
    if (text.starts_with(byte_order_mark)) text.remove_prefix(byte_order_mark.size());
    const std::size_t first = text.find_first_not_of(" \t\r\n");
    return first != std::string_view::npos && text[first] == '{';
}

std::string csv_of_json(std::string_view text, const std::string& file) { return JsonPoses(file).csv(text); }

}  // namespace spawnfield
