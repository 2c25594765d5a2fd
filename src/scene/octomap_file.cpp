#include "scene/octomap_file.h"

#include "base/input_file.h"
#include "base/number.h"

#include <spawnfield/error.h>

#include <cmath>
#include <sstream>

namespace spawnfield {
namespace {

constexpr int max_depth = 16;

/// Header of a .bt or .ot file: lines of `key value` up to `data` (octomap/AbstractOcTree.cpp).
struct Header {
    std::string id;
    double nodes = 0, resolution = 0;
    std::size_t data = 0;  ///< where the nodes start
};

Header read_header(const std::filesystem::path& file, const std::string& bytes, const std::string& kind, const std::string& magic)
{
    const auto refuse = [&](const std::string& what) { throw FileError(file.string(), "is no " + kind + ": " + what); };
    if (!bytes.starts_with(magic)) refuse("its first line is not \"" + magic + "\"");
    const std::size_t data = bytes.find("\ndata\n");
    if (data == std::string::npos) refuse("its header has no line `data`");
    Header header;
    header.data = data + 6;
    std::istringstream lines(bytes.substr(0, data));
    for (std::string line; std::getline(lines, line);) {
        std::string key, value;
        std::istringstream(line) >> key >> value;
        double number = 0;
        if (key == "id") header.id = value;
        if (key == "size" && parse_number(value, number)) header.nodes = number;
        if (key == "res" && parse_number(value, number)) header.resolution = number;
    }
    if (!(header.resolution > 0) || !std::isfinite(header.resolution)) refuse("its header has no line `res` with a number > 0");
    return header;
}

/// Nodes of the tree, two bits for each of eight children; 0 if it is deeper than a tree can be or the bytes end in it.
/// octomap itself reads on past the end, so this looks first.
std::size_t count_nodes(std::string_view data, int depth, std::size_t& at)
{
    if (depth >= max_depth || at + 2 > data.size()) return 0;
    const unsigned bits = static_cast<unsigned char>(data[at]) | unsigned(static_cast<unsigned char>(data[at + 1])) << 8;
    at += 2;
    std::size_t count = 1;
    for (unsigned child = 0; child < 8; ++child) {
        const unsigned code = bits >> (2 * child) & 3;
        if (code == 1 || code == 2) ++count;
        if (code != 3) continue;
        const std::size_t below = count_nodes(data, depth + 1, at);
        if (below == 0) return 0;
        count += below;
    }
    return count;
}

std::unique_ptr<octomap::OcTree> read_binary(const std::filesystem::path& file)
{
    const std::string bytes = read_file(file);
    const Header header = read_header(file, bytes, "binary OctoMap (.bt)", "# Octomap OcTree binary file");
    const std::string_view data = std::string_view(bytes).substr(header.data);
    std::size_t at = 0;
    const std::size_t nodes = header.nodes == 0 ? 0 : count_nodes(data, 0, at);
    if (double(nodes) != header.nodes)
        throw FileError(file.string(), "is cut short or damaged: its header says " + number(header.nodes) + " nodes");
    auto tree = std::make_unique<octomap::OcTree>(header.resolution);
    if (nodes == 0) return tree;
    std::istringstream stream{std::string(data), std::ios::binary};
    tree->readBinaryData(stream);
    return tree;
}

/// Whether the bytes hold a whole tree: of each node a float, a mask of its children, then these (octomap/OcTreeBaseImpl.hxx).
bool is_whole(std::string_view data, int depth, std::size_t& at)
{
    constexpr std::size_t value_size = sizeof(float);
    if (depth > max_depth || at + value_size + 1 > data.size()) return false;
    const unsigned children = static_cast<unsigned char>(data[at + value_size]);
    at += value_size + 1;
    for (unsigned child = 0; child < 8; ++child)
        if ((children >> child & 1) != 0 && !is_whole(data, depth + 1, at)) return false;
    return true;
}

std::unique_ptr<octomap::OcTree> read_full(const std::filesystem::path& file)
{
    const std::string bytes = read_file(file);
    const Header header = read_header(file, bytes, "full OctoMap (.ot)", "# Octomap OcTree file");
    if (header.id != "OcTree") throw FileError(file.string(), "is an OctoMap of type " + header.id + ", needs OcTree");
    auto tree = std::make_unique<octomap::OcTree>(header.resolution);
    if (header.nodes == 0) return tree;
    const std::string_view data = std::string_view(bytes).substr(header.data);
    std::size_t at = 0;
    if (!is_whole(data, 0, at)) throw FileError(file.string(), "is cut short or damaged");
    std::istringstream stream{std::string(data), std::ios::binary};
    tree->readData(stream);
    return tree;
}

}  // namespace

std::unique_ptr<octomap::OcTree> read_octomap(const std::filesystem::path& file)
{
    if (!std::filesystem::is_regular_file(file)) throw FileError(file.string(), "does not exist; is the path right?");
    const std::string extension = file.extension().string();
    return extension == ".ot" || extension == ".OT" ? read_full(file) : read_binary(file);
}

}  // namespace spawnfield
