#include "angle.h"
#include "fleet_args.h"
#include "messages.h"
#include "numbers.h"
#include "output.h"
#include "results.h"

#include <spawnfield/error.h>
#include <spawnfield/input_file.h>
#include <spawnfield/poses.h>
#include <spawnfield/robot_inertia.h>

#include <algorithm>
#include <filesystem>
#include <memory>

namespace spawnfield::cli {
namespace {

namespace fs = std::filesystem;

/// Options of `sample` that have no meaning for fleets, and for as many robots as fit.
const std::vector<std::string> of_places{"--near",        "--on",     "--not-on",        "--clearance",
                                         "--distance-to", "--facing", "--in-view-of",    "--hidden-from",
                                         "--columns",     "--prefer", "--sensor-height", "--view-range"};
const std::vector<std::string> of_one_robot{"--robot",      "--name",      "--namespace",
                                            "--robot-file", "--robot-uri", "--joint-qpos"};

/// Calls `work`. If it throws an ArgumentError about an option that a kind of the fleet file has, throws a FileError
/// that names the key of that file.
template <class Work>
auto for_kind(const FleetInputs& inputs, const FleetFileKind& kind, const Work& work)
{
    try {
        return work();
    } catch (const ArgumentError& error) {
        if (kind.place.empty()) throw;
        std::string words = error.message();
        if (words.starts_with("--")) words.erase(0, 2);
        throw FileError(inputs.fleet.file, kind.place + ": " + words);
    }
}

/// A kind of the fleet, from its options to its robots.
struct Member {
    const FleetFileKind& plan;
    KindArgs args;
    SampleOptions spawns = {};
    ZRange heights = {};
    IslandChoice islands = {};

    Member(const FleetInputs& inputs, const FleetFileKind& kind) : plan(kind), args(inputs, kind) {}

    /// Reads the options, before all work.
    void read(const CLI::App& command)
    {
        const QueryArgs& query = args.query;
        spawns.layers = parse_layers(args.ground.layers);
        spawns.area = read_area(query, args.area);
        spawns.min_distance = args.min_distance;
        spawns.threads = query.threads;
        set_stance(spawns, query, args.ground, command);
        if (const auto box = lone_box(args.area)) {  // as bounds, so that every draw is within the region
            spawns.bounds = *box;
            spawns.area.within.clear();
        }
        heights = heights_of(args.ground, spawns.bounds, "--region");
        const YawChoice yaw = parse_yaw_choice(query, args.yaw, query.is_settled(), true);
        spawns.random_yaw = yaw.is_random;
        spawns.yaw = yaw.yaw;
        spawns.heading = yaw.rule;
        islands = island_choice(query, args.islands, command);
        if (plan.island && !query.is_settled())
            throw ArgumentError(
                "--island is only for settled robots, because islands are where they can drive; leave "
                "--stance level out");
        if (args.fill_step) parse_positive("--fill-step", *args.fill_step);
    }

    /// Completes the options when the map and the robot are known, and prints the notices about them.
    void complete(const Session& session, const CLI::App& command, Summary& summary, bool needs_graph)
    {
        const QueryArgs& query = args.query;
        spawns.z = with_floor(heights, args.ground, session.map);
        const std::size_t words = summary.extra.size();
        spawns.offset = choose_offset(query, spawns.offset, session.robot, summary);
        if (words > 0) summary.extra.resize(words);  // once for the whole fleet
        require_above_ground(session.robot, spawns.offset);
        notice_if_off_map(query, session.map, "--region", spawns.bounds);
        notice_about_area(query, session.map, spawns.area);
        notice_if_no_layer(query, session.map, spawns.layers);
        notices_about_stance(query, command, session.robot);
        notice_about_heading(query, session.map, spawns.heading);
        islands = choice_for(session.map, query, args.islands, command, islands, needs_graph);
    }
};

/// The fleet of `sample --fill`: one kind, whose options are all on the command line.
FleetFile one_kind(const FleetInputs& inputs)
{
    FleetFile out;
    out.kinds.push_back({.name = "robot", .robot = inputs.query.robot});
    out.kinds[0].min_distance = inputs.draws.min_distance;
    return out;
}

void check_options(const FleetInputs& inputs, const CLI::App& command)
{
    const bool is_fill = inputs.fleet.fill;
    const std::string option = is_fill ? "--fill" : "--fleet";
    refuse(command, {"--count", "--pairs"}, "has no effect with " + option + "; leave it out");
    refuse(command, of_places, "is not possible with " + option + ", which has no rules of place; leave it out");
    if (inputs.format == "thesis" || inputs.format == "habitat" || inputs.format == "nav2-goals")
        throw ArgumentError("--format " + inputs.format + " has no fleets; use another format");
    if (is_fill && inputs.query.robot.empty()) throw ArgumentError("--robot is required");
    if (is_fill) {
        DrawArgs draws = inputs.draws;
        draws.count = 1;
        return check_draws(draws);
    }
    refuse(command, of_one_robot, "is for one kind of robot, but the fleet file has names and models; leave it out");
    refuse(command, {"--min-distance"}, "is not possible with --fleet; write min_distance into the fleet file");
}

/// Opens a session for each kind; all share the map.
std::vector<Session> open_sessions(const FleetInputs& inputs, const std::vector<Member>& members, Summary& summary)
{
    std::vector<Session> out;
    for (const Member& member : members)
        for_kind(inputs, member.plan, [&] {
            const QueryArgs& args = member.args.query;
            if (!member.plan.place.empty() && !args.robot.starts_with("box:") && is_missing(args.robot))
                throw FileError(inputs.fleet.file, member.plan.place + ": robot is " + args.robot +
                                                       ", which does not exist; give a path from the folder of this "
                                                       "file, or box:LX,LY,LZ");
            if (out.empty()) return void(out.push_back(open_session(args, summary)));
            Session session{.map = out[0].map, .robot = read_robot(args, args.robot, robot_options(args)), .judge = {}};
            notices(args, session.robot.notices);
            session.judge.emplace(session.map, session.robot, judge_options(args, summary.exact_time()));
            out.push_back(std::move(session));
        });
    return out;
}

/// Finds where a kind of the fleet can drive. The words about it in the summary have the name of the kind.
ReachGraph islands_of_kind(const Member& member, const Session& session, Summary& summary, bool keep_ways = false)
{
    const ReachGraph out = find_islands(member.args.query, member.args.islands, session, summary, "sample", keep_ways);
    if (!member.plan.place.empty()) summary.extra.back().insert(0, member.plan.name + ": ");
    return out;
}

/// Throws FileError if a robot cannot stand at the ends of a convoy's path, before all work on islands.
void check_ends(const FleetInputs& inputs, const std::optional<FormationPlan>& plan, const Member& member,
                const Session& session)
{
    if (!plan || !plan->from_to) return;
    for_kind(inputs, member.plan, [&] {
        check_standing(*session.judge, "from", plan->from_to->first);
        check_standing(*session.judge, "to", plan->from_to->second);
    });
}

/// Lets all kinds stand only on islands: those that they chose, or the linked ones of `one_island`.
void choose_fleet_islands(const FleetFile& file, std::vector<Member>& members, const std::vector<Session>& sessions,
                          Summary& summary)
{
    std::optional<ReachGraph> first_graph;
    std::size_t first_island = 0;
    for (std::size_t k = 0; k < members.size(); ++k) {
        Member& member = members[k];
        if (file.one_island && k == 0 && member.islands.selects_all()) member.islands.largest = true;
        const bool is_linked = file.one_island && k > 0;
        if (!is_linked && member.islands.selects_all()) continue;
        const ReachGraph graph = islands_of_kind(member, sessions[k], summary);
        std::vector<std::size_t> chosen;
        if (!is_linked) {
            chosen = chosen_islands(graph, *sessions[k].judge, member.islands);
        } else if (const auto linked = linked_island(graph, *first_graph, first_island)) {
            chosen = {*linked};
        }
        if (chosen.empty())
            throw NothingFits{"no island is selected for " + member.plan.name +
                              (is_linked ? ": none has ground in common with that of " + members[0].plan.name
                                         : ": none fulfils all conditions, or there is none")};
        if (file.one_island && k == 0) {
            chosen.resize(1);  // the largest one
            first_graph = graph;
            first_island = chosen[0];
        }
        member.spawns.is_reachable = on_islands(graph, chosen);
        member.spawns.reachable_name = is_linked ? "linked with that of " + members[0].plan.name
                                                 : words_of(member.islands);
    }
}

/// Returns a formation with its path. `member` is the kind of its first robot.
Formation formation_of(const FleetInputs& inputs, const FormationPlan& plan, const Member& member,
                       const Session& session, Summary& summary)
{
    Formation out = plan.formation;
    if (!plan.from_to) return out;
    return for_kind(inputs, member.plan, [&] {
        const ReachGraph graph = islands_of_kind(member, session, summary, true);
        out.path = drivable_path(*session.judge, graph, plan.from_to->first, plan.from_to->second);
        return out;
    });
}

bool is_launch(const std::string& format) { return format.starts_with("ros") || format == "sdf"; }

/// Returns whether a launch file or an SDF world can load the robot's own file.
bool is_model(const std::string& robot)
{
    return robot.ends_with(".urdf") || robot.ends_with(".sdf") || is_file(fs::path(robot) / "model.config");
}

/// The files for simulators of a fleet: one for each kind if kinds have models, because each of them is checked.
class FleetOutput {
public:
    FleetOutput(const FleetInputs& inputs, const CLI::App& command, std::vector<Member>& members)
        : inputs_(inputs), writes_bodies_(!inputs.fleet.fill && command.count("--keys") == 0)
    {
        if (!inputs.fleet.fill && inputs.simulator.keys == "each" && !writes_bodies_)
            throw ArgumentError(
                "--keys is each, but the robots of a fleet are together in one world; give --keys "
                "together, or leave it out for a model with all robots");
        for (Member& member : members) {
            if (!outputs_.empty() && !is_launch(inputs.format)) break;
            QueryArgs& query = member.args.query;
            if (!inputs.fleet.fill && is_launch(inputs.format) && member.plan.model.empty() &&
                inputs.simulator.topic.empty() && !is_model(query.robot))
                throw FileError(inputs.fleet.file, member.plan.place + ": model is missing, but --format " +
                                                       inputs.format + " needs it, because " + query.robot +
                                                       " is neither a URDF nor an SDF model; give a file or a URI");
            const bool was_quiet = query.quiet;
            query.quiet = was_quiet || !outputs_.empty();  // notices about options only once
            for_kind(inputs, member.plan, [&] {
                outputs_.push_back(std::make_unique<SimulatorOutput>(
                    query, command, member.args.simulator,
                    SimulatorOutput::Target{inputs.format, inputs.out, query.robot, 1, robot_options(query)}));
            });
            query.quiet = was_quiet;
        }
    }

    /// Reads what the files need of the robots, and prints notices about models and worlds.
    void look_at(const std::vector<Member>& members, const std::vector<Session>& sessions)
    {
        for (std::size_t k = 0; k < members.size() && inputs_.format == "mujoco" && writes_bodies_; ++k) {
            const QueryArgs& query = members[k].args.query;
            inertias_.push_back(robot_inertia(query.robot, robot_options(query)));
            if (!inertias_.back())
                notice(inputs_.query,
                       sessions[k].robot.name +
                           " has no mass and inertia of a rigid body in its file, so MuJoCo computes them "
                           "from its shapes, with its default density; <inertial> in a URDF or SDF file "
                           "gives them");
        }
        for (std::size_t k = 0; k < outputs_.size(); ++k) outputs_[k]->notice_about_model(sessions[k].robot);
        outputs_[0]->notice_about_world(sessions[0].map);
    }

    void write(const Fleet& fleet, std::span<const FleetKind> kinds, const FleetOptions& options) const
    {
        std::vector<RobotStart> robots = robot_starts(fleet);
        const bool has_names = !inputs_.fleet.fill || outputs_[0]->has_names();
        if (inputs_.fleet.fill) outputs_[0]->give_names(robots);
        if (inputs_.format == "csv")
            return write_output(inputs_.query, inputs_.out, [&](const auto& sink) {
                sink(inputs_.fleet.fill ? filled_csv(fleet, kinds[0], has_names, robots) : fleet_csv(fleet, kinds));
            });
        if (is_launch(inputs_.format))
            for (std::size_t i = 0; i < robots.size(); ++i) robots[i].model = outputs_[fleet.robots[i].kind]->model();
        if (inputs_.format == "mujoco" && writes_bodies_) {
            std::vector<Robot> shapes;
            std::vector<std::size_t> kind_of;
            for (const FleetKind& kind : kinds) shapes.push_back(kind.judge.robot());
            for (const FleetRobot& robot : fleet.robots) kind_of.push_back(robot.kind);
            return write_output(inputs_.query, inputs_.out,
                                [&](const auto& sink) { sink(mujoco_bodies(robots, shapes, kind_of, inertias_)); });
        }
        outputs_[0]->write(robots, kinds[0].judge.map(), [&] { return fleet_json(fleet, kinds, options, robots); });
    }

private:
    /// Returns the table that `sample` writes.
    static std::string filled_csv(const Fleet& fleet, const FleetKind& kind, bool has_names,
                                  std::span<const RobotStart> robots)
    {
        SpawnList list;
        list.stance = kind.spawns.stance;
        list.heading = kind.spawns.heading;
        std::vector<std::string> names;
        for (std::size_t i = 0; i < robots.size(); ++i) {
            list.spawns.push_back(fleet.robots[i].spawn);
            if (list.stance == Stance::Settled) list.rests.push_back(fleet.robots[i].rest);
            if (has_names) names.push_back(robots[i].name);
        }
        return spawns_csv(list, names);
    }

    const FleetInputs& inputs_;
    const bool writes_bodies_;  ///< MuJoCo: of a fleet, unless --keys asks for keys alone
    std::vector<std::unique_ptr<SimulatorOutput>> outputs_;
    std::vector<std::optional<RobotInertia>> inertias_;  ///< of each kind, for MuJoCo's bodies
};

/// Returns the number of robots that were asked for. No value: some as many as fit.
std::optional<std::size_t> wanted_robots(std::span<const FleetKind> kinds)
{
    std::size_t out = 0;
    for (const FleetKind& kind : kinds) {
        if (!kind.count) return std::nullopt;
        out += *kind.count;
    }
    return out;
}

void fill(Summary& summary, const Fleet& fleet, std::span<const FleetKind> kinds, const FleetOptions& options)
{
    summary.seed = options.seed;
    const std::optional<std::size_t> wanted = wanted_robots(kinds);
    std::uint64_t draws = 0, close = 0, overlapping = 0;
    for (const FleetKindResult& result : fleet.kinds) {
        draws += result.draws;
        close += result.too_close;
        overlapping += result.overlapping;
    }
    summary.extra.insert(summary.extra.begin(),
                         wanted ? std::to_string(fleet.robots.size()) + " of " + counted(*wanted, "robot")
                                : counted(fleet.robots.size(), "robot"));
    summary.extra.push_back(counted(draws, "drawn pose") + ", " + std::to_string(close) + " too close, " +
                            std::to_string(overlapping) + " overlapping");
    summary.draws = {{"all", draws}, {"too_close", close}, {"overlapping", overlapping}};
}

/// Returns the kinds of the fleet, with their formations.
std::vector<FleetKind> fleet_kinds(const FleetInputs& inputs, const std::vector<Member>& members,
                                   const std::vector<Session>& sessions, Summary& summary)
{
    std::vector<FleetKind> out;
    for (std::size_t k = 0; k < members.size(); ++k) {
        const Member& member = members[k];
        FleetKind& kind = out.emplace_back(FleetKind{.name = member.plan.name, .judge = *sessions[k].judge});
        kind.count = member.plan.count;
        kind.spawns = member.spawns;
        kind.fill_step = member.args.fill_step;
        if (member.plan.formation)
            kind.formation = formation_of(inputs, *member.plan.formation, member, sessions[k], summary);
    }
    return out;
}

Ending ending_of(const Fleet& fleet, const std::vector<FleetKind>& kinds)
{
    bool is_complete = !fleet.robots.empty();
    for (std::size_t k = 0; k < kinds.size(); ++k)
        is_complete = is_complete && fleet.kinds[k].found >= kinds[k].count.value_or(0);
    return {.status = is_complete ? done : fewer_found, .notice = fleet_words(fleet, kinds)};
}

}  // namespace

Ending run_fleet(const FleetInputs& inputs, const CLI::App& command, Summary& summary)
{
    check_options(inputs, command);
    const FleetFile file = inputs.fleet.fill ? one_kind(inputs) : read_fleet(inputs.fleet.file);
    if (file.one_island && !inputs.query.is_settled())
        throw FileError(inputs.fleet.file,
                        "one_island is true, but it is only for settled robots, because islands are "
                        "where they can drive; leave --stance level out");
    Member(inputs, FleetFileKind{}).read(command);  // refuses wrong options of the command line itself
    std::vector<Member> members;
    for (const FleetFileKind& kind : file.kinds) members.emplace_back(inputs, kind);
    const std::vector<AvoidedPoints> avoid = read_avoided(inputs.query, inputs.avoid, inputs.draws.min_distance);
    bool needs_graph = file.one_island || (file.formation && file.formation->from_to);
    for (Member& member : members) {
        for_kind(inputs, member.plan, [&] { member.read(command); });
        member.spawns.avoid = avoid;
        needs_graph = needs_graph || !member.islands.selects_all() ||
                      (member.plan.formation && member.plan.formation->from_to);
    }
    FleetOutput output(inputs, command, members);
    const std::vector<Session> sessions = open_sessions(inputs, members, summary);
    for (std::size_t k = 0; k < members.size(); ++k)
        for_kind(inputs, members[k].plan, [&] { members[k].complete(sessions[k], command, summary, needs_graph); });
    notice_about_avoided(inputs.query, sessions[0].map, avoid);
    output.look_at(members, sessions);
    summary.lap("load");
    check_ends(inputs, file.formation, members[0], sessions[0]);
    for (std::size_t k = 0; k < members.size(); ++k)
        check_ends(inputs, members[k].plan.formation, members[k], sessions[k]);
    choose_fleet_islands(file, members, sessions, summary);
    const std::vector<FleetKind> kinds = fleet_kinds(inputs, members, sessions, summary);
    FleetOptions options{.min_distance = file.min_distance,
                         .between = file.between,
                         .seed = inputs.draws.seed,
                         .threads = inputs.query.threads,
                         .progress = progress_bar(inputs.query, "sample", false),
                         .stop = stop_request(inputs.query)};
    if (file.formation) options.formation = formation_of(inputs, *file.formation, members[0], sessions[0], summary);
    Fleet fleet = place_fleet(kinds, options);
    summary.is_interrupted = end_interruptible_work(inputs.query, !fleet.robots.empty());
    summary.lap("query");
    output.write(fleet, kinds, options);
    fill(summary, fleet, kinds, options);
    Ending ending = summary.is_interrupted ? interrupted_ending(fleet.robots.size(), "robot", wanted_robots(kinds))
                                           : ending_of(fleet, kinds);
    std::vector<std::string> names;
    for (const FleetKind& kind : kinds) names.push_back(kind.name);
    keep(inputs.query, FoundFleet{std::move(fleet), std::move(names)});
    return ending;
}

}  // namespace spawnfield::cli
