#include <spawnfield/kept_graph.h>

#include "base/binary.h"
#include "base/checksum.h"
#include "base/deflate.h"
#include "query/pose_judge.h"
#include "reach/reach_graph.h"

#include <spawnfield/error.h>
#include <spawnfield/input_file.h>
#include <spawnfield/output_file.h>

#include <stdexcept>
#include <string_view>

namespace spawnfield {

namespace fs = std::filesystem;

namespace {

/// Raise this if the places, nodes or islands of the same map and robot change, or the bytes of the file.
constexpr std::uint32_t graph_version = 3;
constexpr std::string_view magic = "spawnfield-reach";
constexpr std::size_t checksum_size = 16;

void put(BinaryWriter& out, const Vec3& values)
{
    for (int axis = 0; axis < 3; ++axis) out.put(values[axis]);
}

void put(BinaryWriter& out, const RobotPart& part)
{
    const Shape& shape = part.shape;
    out.put(std::uint8_t(shape.kind));
    put(out, shape.size);
    put(out, shape.pose.position);
    for (int axis = 0; axis < 3; ++axis) put(out, Vec3(shape.pose.rotation.col(axis)));
    out.put(std::uint64_t(part.hull_vertices.size()));
    for (const Vec3& vertex : part.hull_vertices) put(out, vertex);
}

/// Returns a hash of everything on which a graph depends, except the files of the map.
std::string key_of(const Judge& judge, const ReachOptions& given)
{
    const ReachOptions options = with_defaults(given, judge.robot());
    BinaryWriter out;
    out.put(graph_version);
    out.put_text(version());
    const Map& map = judge.map();
    put(out, map.bounds.min);
    put(out, map.bounds.max);
    out.put(map.z_limits.low);
    out.put(map.z_limits.high);
    for (const RobotPart& part : judge.robot().parts) put(out, part);
    put(out, mass_center_of(judge.robot()));
    const JudgeOptions& limits = judge.impl().options;
    out.put(limits.max_height);
    out.put(limits.max_water_depth);
    const StandLimits& stand = limits.stand;
    for (const double limit : {stand.lift, stand.max_slope, stand.max_tilt, *stand.min_stability, stand.friction})
        out.put(limit);
    out.put(std::uint8_t(stand.drop.has_value()));
    out.put(stand.drop.value_or(0));
    out.put(std::uint8_t(*options.drive));
    out.put(*options.max_step);
    out.put(options.turning_radius.value_or(0));
    out.put(*options.step);
    out.put(std::uint8_t(options.keep_ways));
    return checksum(out.take());
}

std::string file_bytes(const ReachGraph::Impl& graph)
{
    const std::string values = graph.bytes();
    BinaryWriter size;
    size.put(std::uint64_t(values.size()));
    const std::string content = size.take() + deflate_bytes(values);
    return std::string(magic) + checksum(content) + content;
}

/// Returns the bytes that were given to file_bytes(). Throws std::exception if they are damaged.
std::string values_in(std::string_view file)
{
    constexpr std::size_t head = magic.size() + checksum_size;
    if (!file.starts_with(magic) || file.size() < head + sizeof(std::uint64_t))
        throw std::runtime_error("it is cut short, or not a kept graph");
    const std::string_view content = file.substr(head);
    if (file.substr(magic.size(), checksum_size) != checksum(content))
        throw std::runtime_error("its checksum is wrong");
    return inflate_bytes(content.substr(sizeof(std::uint64_t)), BinaryReader(content).get<std::uint64_t>());
}

}  // namespace

fs::path kept_graph_file(const Judge& judge, const ReachOptions& options)
{
    const Map& map = judge.map();
    if (map.folder.empty() || map.hash.empty() || judge.impl().options.exhaustive) return {};
    return map.folder / ("reach-" + map.hash + "-" + key_of(judge, options) + ".bin");
}

namespace {

/// Reads a kept graph. Returns nothing if there is none. Adds a notice if it cannot be used.
std::optional<ReachGraph> read_kept(const Judge& judge, const ReachOptions& options, std::string& notice)
{
    using Impl = ReachGraph::Impl;
    const fs::path file = kept_graph_file(judge, options);
    if (!does_exist(file)) return std::nullopt;
    try {
        const auto keep = options.keep_ways ? Impl::Keep::Ways : Impl::Keep::Islands;
        return ReachGraph(std::make_shared<const Impl>(judge, options, keep, values_in(read_file(file))));
    } catch (const std::exception& error) {
        notice = file.string() + ": the kept graph cannot be used: " + error.what() + "; it is built again";
        return std::nullopt;
    }
}

}  // namespace

KeptGraph kept_graph(const Judge& judge, const ReachOptions& options)
{
    const fs::path file = kept_graph_file(judge, options);
    if (file.empty()) return {ReachGraph(judge, options)};
    std::string notice;
    if (auto graph = read_kept(judge, options, notice)) return {*std::move(graph), true, ""};
    if (!options.keep_ways) {  // a graph with ways contains the islands, too
        ReachOptions with_ways = options;
        with_ways.keep_ways = true;
        std::string ignored;
        if (auto graph = read_kept(judge, with_ways, ignored)) return {*std::move(graph), true, notice};
    }
    ReachGraph graph(judge, options);
    try {
        write_file_atomically(file, file_bytes(*graph.impl()));
    } catch (const OutputError& error) {
        notice = std::string("the graph is not kept, and will be built again next time: ") + error.what();
    }
    return {std::move(graph), false, notice};
}

}  // namespace spawnfield
