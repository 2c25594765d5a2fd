#include "cli.h"

#include "interrupt.h"
#include "notices.h"
#include "streams.h"

#include <spawnfield/error.h>
#include <spawnfield/output_file.h>

#include <unistd.h>

#include <atomic>
#include <charconv>
#include <chrono>
#include <cmath>
#include <csignal>
#include <cstdio>
#include <iostream>
#include <numbers>

namespace spawnfield::cli {
namespace {

std::atomic<bool> interrupt_seen{false};
static_assert(std::atomic<bool>::is_always_lock_free, "a signal handler may only touch lock-free atomics");

void note_interrupt(int signal)
{
    interrupt_seen = true;
    std::signal(signal, SIG_DFL);
}

bool bar_shown = false;

}  // namespace

void catch_interrupts()
{
    for (const int signal : {SIGINT, SIGTERM, SIGHUP})
        if (std::signal(signal, note_interrupt) == SIG_IGN) std::signal(signal, SIG_IGN);  // as nohup wants it
}

bool was_interrupted() { return interrupt_seen; }

void add_common(CLI::App& command, CommonArgs& args)
{
    command.add_option("--threads", args.threads, "Threads; 0: all cores. The result is the same at any number")
        ->check(CLI::Range(0, most_threads));
    command.add_flag("--quiet,-q", args.quiet, "No notices, no progress, no summary line");
    command.add_option("--summary", args.summary, "Write the summary to this file as JSON (- for standard output)");
}

void add_allow_empty(CLI::App& command, CommonArgs& args)
{
    command.add_flag("--allow-empty", args.allow_empty, "Accept a file of poses that has a header but no pose");
}

void add_query(CLI::App& command, QueryArgs& args)
{
    command.add_option("map", args.map, "Map folder, from `spawnfield bake`")->required();
    command.add_option("--robot,-r", args.robot, "robot.yaml, a .urdf, an SDF model, or box:LX,LY,LZ[@x,y,z] (m)")
        ->required()
        ->check(not_empty());
    add_robot_options(command, args);
    command.add_option("--max-height", args.max_height,
                       "Most metres of the robot's origin above its ground (default 1)");
    command.add_option("--max-water-depth", args.max_water_depth,
                       "Water higher than this above the ground does not count, m (default: all does)");
    command.add_option("--max-slope", args.max_slope,
                       "Ask poses that would be valid how they stand too: steep above so many degrees, unstable over "
                       "an edge (default: not asked)");
    command
        .add_option("--collision", args.collision,
                    "What the robot must not touch: geometry (exact), or octree (the baked voxels)")
        ->check(one_of({"geometry", "octree"}));
    command.add_flag("--exhaustive", args.exhaustive,
                     "Check every pose exactly, without the free-space mask: the same answers, slowly");
    add_common(command, args);
}

CLI::Validator not_empty()
{
    return {[](const std::string& text) { return text.empty() ? "is empty: is a shell's variable not set?" : ""; }, ""};
}

void refuse(const CLI::App& command, const std::vector<std::string>& options, const std::string& reason)
{
    for (const std::string& option : options)
        if (command.count(option) > 0) throw ArgumentError(option + " " + reason);
}

void tell_idle(const CommonArgs& args, const CLI::App& command, const std::vector<std::string>& options,
               const std::string& reason)
{
    for (const std::string& option : options)
        if (command.count(option) > 0) notice(args, option + " has no effect: " + reason);
}

void notice(const CommonArgs& args, const std::string& text)
{
    if (args.quiet) return;
    clear_progress_bar();
    std::cerr << "notice: " << text << "\n";
}

void notices(const CommonArgs& args, const std::vector<std::string>& texts)
{
    for (const std::string& text : grouped(texts)) notice(args, text);
}

std::string number(double value)
{
    char text[32];
    return {text, std::to_chars(text, text + sizeof text, value).ptr};
}

std::string counted(std::uint64_t count, const std::string& noun)
{
    return std::to_string(count) + " " + noun + (count == 1 ? "" : "s");
}

Progress progress_bar(const CommonArgs& args, const std::string& label)
{
    const bool shown = !args.quiet && isatty(STDERR_FILENO) != 0;
    using Clock = std::chrono::steady_clock;
    auto last = std::make_shared<Clock::time_point>(Clock::now());
    return [=](double share) {
        if (was_interrupted()) throw Interrupted{};
        const auto now = Clock::now();
        if (!shown || now - *last < std::chrono::milliseconds(100)) return;
        *last = now;
        const int width = 30, full = int(share * width);
        std::fprintf(stderr, "\r%s [%s%s] %3d %%", label.c_str(), std::string(full, '#').c_str(),
                     std::string(width - full, ' ').c_str(), int(share * 100));
        bar_shown = true;
    };
}

void clear_progress_bar()
{
    if (bar_shown) std::fprintf(stderr, "\r%70s\r", "");
    bar_shown = false;
}

ArgumentError bad_value(const std::string& option, double value, const std::string& limit)
{
    return ArgumentError(option + " is " + number(value) + ", needs " + limit);
}

std::vector<double> parse_numbers(const std::string& option, const std::string& text, char separator)
{
    std::vector<double> out;
    for (std::size_t start = 0; start <= text.size();) {
        const std::size_t between = std::min(text.find(separator, start), text.size());
        double value = 0;
        const char* const end = text.data() + between;
        const auto [stop, error] = std::from_chars(text.data() + start, end, value);
        if (error != std::errc{} || stop != end || !std::isfinite(value))
            throw ArgumentError(option + ": \"" + text.substr(start, between - start) + "\" is no finite number");
        out.push_back(value);
        start = between + 1;
    }
    return out;
}

Bounds parse_bounds(const std::string& option, const std::string& text, bool flat_allowed)
{
    const auto v = parse_numbers(option, text);
    Bounds bounds;
    if (v.size() == 6) {
        bounds = {Vec3(v[0], v[1], v[2]), Vec3(v[3], v[4], v[5])};
    } else if (v.size() == 4 && flat_allowed) {
        const ZRange all;
        bounds = {Vec3(v[0], v[1], all.low), Vec3(v[2], v[3], all.high)};
    } else {
        throw ArgumentError(option + " has " + std::to_string(v.size()) + " numbers, needs 6: x0,y0,z0,x1,y1,z1" +
                            (flat_allowed ? " (or 4: x0,y0,x1,y1)" : ""));
    }
    for (const double value : v)
        if (!(std::abs(value) <= 1e7)) throw bad_value(option, value, "numbers between -1e7 and 1e7, m");
    for (int axis = 0; axis < 3; ++axis)
        if (bounds.min[axis] > bounds.max[axis])
            throw bad_value(option + ": " + "xyz"[axis] + "1", bounds.max[axis],
                            std::string("at least ") + "xyz"[axis] + "0: the lower corner comes first");
    return bounds;
}

std::string bounds_text(const Bounds& bounds, int axes)
{
    std::string text;
    for (const Vec3& corner : {bounds.min, bounds.max})
        for (int axis = 0; axis < axes; ++axis) text += (text.empty() ? "" : ",") + number(corner[axis]);
    return text;
}

LayerChoice parse_layers(const std::string& text)
{
    if (text == "all") return {LayerChoice::Kind::All, 0};
    if (text == "top") return {LayerChoice::Kind::Top, 0};
    if (text == "bottom") return {LayerChoice::Kind::Bottom, 0};
    int index = 0;
    const auto [stop, error] = std::from_chars(text.data(), text.data() + text.size(), index);
    if (error != std::errc{} || stop != text.data() + text.size() || index < 0)
        throw ArgumentError("--layers is \"" + text + "\", needs all, top, bottom or a number from 0 (the highest) on");
    return {LayerChoice::Kind::Index, index};
}

double parse_positive(const std::string& option, double value)
{
    if (!(value > 0) || !std::isfinite(value)) throw bad_value(option, value, "> 0");
    return value;
}

double parse_finite(const std::string& option, double value, const std::string& unit)
{
    if (!std::isfinite(value)) throw bad_value(option, value, "a finite number, " + unit);
    if (std::abs(value) > 1e7) throw bad_value(option, value, "at most 1e7 " + unit);  // as far as scenes reach
    return value;
}

PoseTable open_poses(const CommonArgs& args, const std::string& file)
{
    PoseTable table = is_standard(file) ? parse_poses(read_standard_input(), input_name(file), args.allow_empty)
                                        : read_poses(file, args.allow_empty);
    for (const std::string& text : table.notices) notice(args, text);
    return table;
}

namespace {

/// Most likely units: a robot of a drawing in millimetres, or a world in kilometres.
void tell_if_larger_than_map(const CommonArgs& args, const Robot& robot, const Map& map)
{
    const Bounds box = robot.bounds();
    const Vec3 size = box.max - box.min, room = map.bounds.max - map.bounds.min;
    if (size.head<2>().maxCoeff() <= room.head<2>().maxCoeff()) return;
    char text[300];
    std::snprintf(text, sizeof text,
                  "the robot is %.6g x %.6g m, larger than the map (%.6g x %.6g m); is one of them in other units than "
                  "metres? `scale` in a robot.yaml or scene.yaml, or bake --scale, corrects it",
                  size.x(), size.y(), room.x(), room.y());
    notice(args, text);
}

/// Throws ArgumentError for limits out of range.
JudgeOptions judge_options(const QueryArgs& args, ExactTime& exact_time)
{
    if (args.max_slope && !(*args.max_slope > 0 && *args.max_slope < 90))
        throw bad_value("--max-slope", *args.max_slope, "> 0 and < 90 degrees");
    if (!(args.max_height >= 0)) throw bad_value("--max-height", args.max_height, ">= 0 m");
    if (!(args.max_water_depth >= 0)) throw bad_value("--max-water-depth", args.max_water_depth, ">= 0 m");
    JudgeOptions out{.max_height = args.max_height,
                     .max_water_depth = args.max_water_depth,
                     .obstacles = args.collision == "octree" ? Obstacles::Voxels : Obstacles::Geometry,
                     .exhaustive = args.exhaustive,
                     .exact_time = &exact_time};
    if (args.max_slope) out.max_slope = *args.max_slope * std::numbers::pi / 180;
    return out;
}

}  // namespace

Session open_session(const QueryArgs& args, Summary& summary)
{
    const JudgeOptions options = judge_options(args, summary.exact_time);
    Session session;
    if (!args.robot.empty()) {
        session.robot = load_robot(args.robot, robot_options(args));
        notices(args, session.robot.notices);
    }
    session.map = read_map(args.map);
    if (args.robot.empty()) return session;
    tell_if_larger_than_map(args, session.robot, session.map);
    session.judge.emplace(session.map, session.robot, options);
    return session;
}

void tell_if_off_map(const CommonArgs& args, const Map& map, const std::string& option, const Bounds& bounds)
{
    if (!bounds.is_empty() && !bounds.meets(map.bounds, 2))
        notice(args, option + " " + to_string(bounds, 2) + " lies off the map, which is " + to_string(map.bounds, 2));
}

void tell_if_no_layer(const CommonArgs& args, const Map& map, const LayerChoice& layers)
{
    if (layers.kind == LayerChoice::Kind::Index && layers.index >= map.layers)
        notice(args, "--layers " + std::to_string(layers.index) + ": no cell of the map has so many, the most is " +
                         counted(std::uint64_t(map.layers), "layer") + " (0 is the highest)");
}

void write_output(const std::string& file,
                  const std::function<void(const std::function<void(std::string_view)>&)>& writer,
                  const std::function<void()>& then)
{
    clear_progress_bar();
    if (file.empty() || is_standard(file)) {
        writer([](std::string_view text) { std::cout << text; });
        std::cout.flush();
        if (!std::cout) throw OutputError("standard output", "cannot be written");
        then();
        return;
    }
    OutputFile out(file);
    writer([&](std::string_view text) {
        if (was_interrupted()) throw Interrupted{};
        out.write(text);
    });
    out.flush();
    if (was_interrupted()) throw Interrupted{};
    then();
    out.commit();
}

}  // namespace spawnfield::cli
