#include "mesh_reader/gltf_check.h"

#include <spawnfield/error.h>

#include <nlohmann/json.hpp>

#include <algorithm>
#include <cstdint>
#include <cstring>
#include <unordered_map>
#include <unordered_set>
#include <utility>
#include <vector>

namespace spawnfield {
namespace {

using Json = nlohmann::json;

constexpr std::size_t most_nested = 200, most_scene_depth = 500;
constexpr std::uint64_t most_used = 300000000;  // 100 million triangles

/// Nodes, scenes and accessors of a file. A node's name here is its index in the list of nodes, or its key in glTF 1.0:
/// other nodes refer to it by this name.
struct Nodes {
    struct Node {
        std::string name;
        std::vector<std::string> children;
    };
    std::vector<Node> nodes;
    std::vector<std::vector<std::string>> scenes;  ///< root nodes of each scene
    std::vector<std::uint64_t> counts;             ///< of each accessor (glTF 2.0)
    std::vector<std::uint64_t> used;  ///< accessors of vertices and corners, once for each primitive that uses them
};

/// Collects nodes, scenes and accessors while the JSON is parsed. The rest, which is mostly data, is not kept in
/// memory.
class NodeReader : public nlohmann::json_sax<Json> {
public:
    explicit NodeReader(const std::string& file) : file_(file) {}
    Nodes take() { return std::move(found_); }

    bool null() override { return value(""); }
    bool boolean(bool) override { return value(""); }
    bool number_integer(number_integer_t number) override { return value(std::to_string(number)); }
    bool number_unsigned(number_unsigned_t number) override
    {
        const auto in = [&](std::size_t depth, const char* key) {
            return open_.size() == depth && !open_.back().array && open_.back().key == key;
        };
        if (in(3, "count") && is_in("accessors")) found_.counts.back() = number;
        if ((in(5, "indices") || in(6, "POSITION")) && is_in("meshes")) found_.used.push_back(number);
        return value(std::to_string(number));
    }
    bool number_float(number_float_t, const string_t& text) override { return value(text); }
    bool string(string_t& text) override { return value(text); }
    bool binary(binary_t&) override { return true; }
    bool start_object(std::size_t) override { return open(false); }
    bool end_object() override { return close(); }
    bool start_array(std::size_t) override { return open(true); }
    bool end_array() override { return close(); }
    bool key(string_t& name) override
    {
        const auto again = [&](const char* list, bool& has) {
            return open_.size() == 1 && name == list && std::exchange(has, true);
        };
        if (again("nodes", has_nodes_) || again("scenes", has_scenes_))
            throw FileError(file_, "has the key \"" + name + "\" twice, needs it once");
        open_.back().key = name;
        return true;
    }
    bool parse_error(std::size_t, const std::string&, const nlohmann::detail::exception& error) override
    {
        const std::string what = error.what();  // "[json.exception.parse_error.101] parse error at line 1, column 2: …"
        throw FileError(file_, "cannot be read as a mesh: not valid JSON: " +
                                   what.substr(std::min(what.find("] ") + 2, what.size())));
    }

private:
    struct Open {
        bool array = false;
        std::string key;        ///< of an object: the current key
        std::size_t index = 0;  ///< of an array: the current index
    };

    std::string name_in(const Open& list) const { return list.array ? std::to_string(list.index) : list.key; }
    bool is_in(const char* list) const { return open_.size() > 1 && !open_[0].array && open_[0].key == list; }

    bool open(bool array)
    {
        if (open_.size() == most_nested)
            throw FileError(file_, "its JSON is nested more than " + std::to_string(most_nested) + " deep" +
                                       (open_[0].array ? "" : ", in \"" + open_[0].key + "\""));
        if (!array && open_.size() == 2 && is_in("nodes")) found_.nodes.push_back({name_in(open_[1]), {}});
        if (!array && open_.size() == 2 && is_in("scenes")) found_.scenes.emplace_back();
        if (!array && open_.size() == 2 && is_in("accessors")) found_.counts.push_back(0);
        open_.push_back({array, {}, 0});
        return true;
    }

    bool close()
    {
        open_.pop_back();
        step();
        return true;
    }

    /// Takes a number or a text. Values in nodes[…].children[…] and scenes[…].nodes[…] are names of nodes.
    bool value(const std::string& text)
    {
        if (open_.size() == 4 && open_[3].array && !open_[2].array) {
            if (is_in("nodes") && open_[2].key == "children") found_.nodes.back().children.push_back(text);
            if (is_in("scenes") && open_[2].key == "nodes") found_.scenes.back().push_back(text);
        }
        step();
        return true;
    }

    void step()
    {
        if (!open_.empty() && open_.back().array) ++open_.back().index;
    }

    const std::string& file_;
    std::vector<Open> open_;
    bool has_nodes_ = false, has_scenes_ = false;
    Nodes found_;
};

/// Checks that the nodes form trees: each node has at most one parent, and is not below itself.
class TreeCheck {
public:
    TreeCheck(const Nodes& nodes, const std::string& file)
        : nodes_(nodes.nodes), file_(file), parents_(nodes_.size(), none)
    {
        for (std::size_t n = 0; n < nodes_.size(); ++n)
            if (!places_.try_emplace(nodes_[n].name, n).second)
                throw FileError(file, "nodes has \"" + nodes_[n].name + "\" twice, needs it once");
        for (std::size_t n = 0; n < nodes_.size(); ++n) add_children(n);
        for (std::size_t s = 0; s < nodes.scenes.size(); ++s) check_scene(s, nodes.scenes[s]);
        check_depth();
    }

private:
    static constexpr std::size_t none = ~std::size_t(0);

    static std::string place_of(const std::string& name) { return "nodes[" + name.substr(0, 40) + "]"; }

    std::size_t place(const std::string& name, const std::string& who) const
    {
        const auto found = places_.find(name);
        if (found == places_.end())
            throw FileError(file_, who + " has \"" + name.substr(0, 40) + "\", which is not one of the " +
                                       std::to_string(nodes_.size()) + " nodes");
        return found->second;
    }

    void add_children(std::size_t parent)
    {
        const std::string who = place_of(nodes_[parent].name);
        for (const std::string& name : nodes_[parent].children) {
            const std::size_t child = place(name, who + ".children");
            if (parents_[child] != none)
                throw FileError(file_, place_of(name) + " is a child of " + place_of(nodes_[parents_[child]].name) +
                                           " and again of " + who +
                                           ", needs one parent; give each parent a node of its own");
            parents_[child] = parent;
        }
    }

    void check_scene(std::size_t scene, const std::vector<std::string>& names)
    {
        std::unordered_set<std::size_t> seen;
        const std::string who = "scenes[" + std::to_string(scene) + "].nodes";
        for (const std::string& name : names) {
            const std::size_t node = place(name, who);
            if (!seen.insert(node).second)
                throw FileError(file_, who + " has " + place_of(name) + " twice, needs it once");
            if (parents_[node] != none)
                throw FileError(file_, who + " has " + place_of(name) + ", which is a child of " +
                                           place_of(nodes_[parents_[node]].name) + ", needs nodes without a parent");
        }
    }

    void check_depth() const
    {
        std::vector<std::size_t> level, next;
        for (std::size_t n = 0; n < nodes_.size(); ++n)
            if (parents_[n] == none) level.push_back(n);
        std::vector<char> reached(nodes_.size(), 0);
        for (std::size_t depth = 1; !level.empty(); ++depth, level = std::exchange(next, {}))
            for (const std::size_t node : level) {
                if (depth > most_scene_depth)
                    throw FileError(file_, place_of(nodes_[node].name) + " is nested more than " +
                                               std::to_string(most_scene_depth) + " deep; merge nodes");
                reached[node] = 1;
                for (const std::string& child : nodes_[node].children) next.push_back(places_.at(child));
            }
        const auto unreached = std::find(reached.begin(), reached.end(), 0);
        if (unreached != reached.end())
            throw FileError(file_, place_of(nodes_[std::size_t(unreached - reached.begin())].name) +
                                       " is below itself through children; remove the circle");
    }

    const std::vector<Nodes::Node>& nodes_;
    const std::string& file_;
    std::unordered_map<std::string, std::size_t> places_;
    std::vector<std::size_t> parents_;
};

/// Limits vertices and corners. assimp reads an accessor again for each primitive that uses it, so a small file can
/// need any amount of memory.
void check_used(const Nodes& found, const std::string& file)
{
    std::uint64_t remaining = most_used;
    for (const std::uint64_t accessor : found.used) {
        const std::uint64_t count = accessor < found.counts.size() ? found.counts[accessor] : 0;
        if (count > remaining)
            throw FileError(file, "its primitives have more than " + std::to_string(most_used) +
                                      " vertices and corners, counted once for each use of an accessor; needs fewer: "
                                      "repeat meshes by nodes, or bake parts of the file");
        remaining -= count;
    }
}

}  // namespace

std::string_view gltf_json(std::string_view bytes, const std::string& file)
{
    constexpr std::size_t head = 20;
    if (!bytes.starts_with("glTF")) return bytes;
    std::uint32_t size = 0;
    if (bytes.size() >= head) std::memcpy(&size, bytes.data() + 12, sizeof size);
    if (bytes.size() < head || size > bytes.size() - head)
        throw FileError(file, "ends within its JSON (its header declares " + std::to_string(size) +
                                  " bytes of JSON, the file has " + std::to_string(bytes.size()) +
                                  " bytes); is it cut short?");
    const std::string_view json = bytes.substr(head, size);
    return json.substr(0, json.find_last_not_of('\0') + 1);  // some programs pad with zeros instead of spaces
}

void check_gltf(std::string_view bytes, const std::string& file)
{
    const std::string_view json = gltf_json(bytes, file);
    NodeReader reader(file);
    Json::sax_parse(json.begin(), json.end(), &reader);
    const Nodes found = reader.take();
    TreeCheck(found, file);
    check_used(found, file);
}

}  // namespace spawnfield
