#include "scene/octomap_file.h"

#include "base/input_file.h"
#include "base/input_watch.h"
#include "base/number.h"

#include <spawnfield/error.h>

#include <cmath>
#include <sstream>

namespace spawnfield {
namespace {

constexpr int max_depth = 16;

/// The header of a .bt or .ot file: lines of `key value` up to `data` (octomap/AbstractOcTree.cpp).
struct OctoMapHeader {
    std::string id;
    double nodes = 0, resolution = 0;
    std::size_t data = 0;  ///< offset of the nodes in the file
};

OctoMapHeader read_header(const std::filesystem::path& file, const std::string& bytes, const std::string& kind,
                          const std::string& magic)
{
    const auto refuse = [&](const std::string& what) {
        throw FileError(file.string(), "is not a " + kind + ": " + what);
    };
    if (!bytes.starts_with(magic)) refuse("its first line is not \"" + magic + "\"");
    const std::size_t data = bytes.find("\ndata\n");
    if (data == std::string::npos) refuse("its header has no line `data`");
    OctoMapHeader header;
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
    if (!(header.resolution > 0) || !std::isfinite(header.resolution))
        refuse("its header has no line `res` with a number > 0");
    return header;
}

/// Types of trees that store log-odds of occupancy in the same way. Other types store something else.
constexpr const char* known_types = "OcTree, ColorOcTree or OcTreeStamped";

void check_type(const std::filesystem::path& file, const OctoMapHeader& header)
{
    if (header.id == "OcTree" || header.id == "ColorOcTree" || header.id == "OcTreeStamped") return;
    throw FileError(file.string(),
                    "is an OctoMap of type " + (header.id.empty() ? "\"\"" : header.id) + ", needs " + known_types);
}

/// Returns the number of nodes. A node has two bits for each of its eight children: 0 unknown, 1 a free leaf, 2 an
/// occupied leaf, 3 a node with children, whose bits follow. Returns 0 if the tree is too deep or the bytes end too
/// early. octomap itself does not check this and would read past the end.
std::size_t count_nodes(std::string_view data, int depth, std::size_t& position)
{
    if (depth >= max_depth || position + 2 > data.size()) return 0;
    const unsigned bits = static_cast<unsigned char>(data[position]) |
                          unsigned(static_cast<unsigned char>(data[position + 1])) << 8;
    position += 2;
    std::size_t count = 1;
    for (unsigned child = 0; child < 8; ++child) {
        const unsigned code = bits >> (2 * child) & 3;
        if (code == 1 || code == 2) ++count;
        if (code != 3) continue;
        const std::size_t below = count_nodes(data, depth + 1, position);
        if (below == 0) return 0;
        count += below;
    }
    return count;
}

std::unique_ptr<octomap::OcTree> read_binary(const std::filesystem::path& file)
{
    const std::string bytes = read_file(file);
    const OctoMapHeader header = read_header(file, bytes, "binary OctoMap (.bt)", "# Octomap OcTree binary file");
    check_type(file, header);
    const std::string_view data = std::string_view(bytes).substr(header.data);
    std::size_t position = 0;
    const std::size_t nodes = header.nodes == 0 ? 0 : count_nodes(data, 0, position);
    if (double(nodes) != header.nodes)
        throw FileError(file.string(), "is cut short or damaged: it does not have the " + number(header.nodes) +
                                           " nodes that its header declares");
    auto tree = std::make_unique<octomap::OcTree>(header.resolution);
    if (nodes == 0) return tree;
    std::istringstream stream{std::string(data), std::ios::binary};
    tree->readBinaryData(stream);
    return tree;
}

/// Copies a tree without the `extra` bytes of its nodes. Returns false if the tree is too deep or the bytes end too
/// early. A node consists of a float (its log-odds), `extra` bytes, a bit mask of its children, then the children
/// (octomap/OcTreeBaseImpl.hxx).
bool copy_log_odds(std::string_view data, std::size_t extra, int depth, std::size_t& position, std::string& out)
{
    constexpr std::size_t value_size = sizeof(float);
    if (depth > max_depth || position + value_size + extra + 1 > data.size()) return false;
    out += data.substr(position, value_size);
    out += data[position + value_size + extra];
    const unsigned children = static_cast<unsigned char>(out.back());
    position += value_size + extra + 1;
    for (unsigned child = 0; child < 8; ++child)
        if ((children >> child & 1) != 0 && !copy_log_odds(data, extra, depth + 1, position, out)) return false;
    return true;
}

std::unique_ptr<octomap::OcTree> read_full(const std::filesystem::path& file)
{
    const std::string bytes = read_file(file);
    const OctoMapHeader header = read_header(file, bytes, "full OctoMap (.ot)", "# Octomap OcTree file");
    check_type(file, header);
    auto tree = std::make_unique<octomap::OcTree>(header.resolution);
    if (header.nodes == 0) return tree;
    const std::string_view data = std::string_view(bytes).substr(header.data);
    const std::size_t extra = header.id == "ColorOcTree" ? 3 : 0;  // red, green, blue
    std::size_t position = 0;
    std::string plain;
    if (!copy_log_odds(data, extra, 0, position, plain)) throw FileError(file.string(), "is cut short or damaged");
    std::istringstream stream{plain, std::ios::binary};
    tree->readData(stream);
    return tree;
}

}  // namespace

std::unique_ptr<octomap::OcTree> read_octomap(const std::filesystem::path& file)
{
    const ForeignReading reading("OctoMap reader", file);
    const std::string extension = file.extension().string();
    return extension == ".ot" || extension == ".OT" ? read_full(file) : read_binary(file);
}

}  // namespace spawnfield
