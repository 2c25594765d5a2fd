#include "review_live.h"

#include "area_args.h"
#include "command.h"
#include "host.h"
#include "messages.h"
#include "results.h"
#include "shell_words.h"
#include "spelling.h"

#include <spawnfield/error.h>
#include <spawnfield/local_server.h>
#include <spawnfield/poses.h>

#include <nlohmann/json.hpp>

#include <algorithm>
#include <chrono>
#include <cstring>
#include <set>

namespace spawnfield::cli {
namespace {

using Json = nlohmann::ordered_json;

/// Which queries use a control.
enum class For { All, Layers, Spawns };

/// An option that the page can change.
struct Control {
    const char *option, *name, *type, *group, *unit = "";
    For use = For::All;
    const char* value = "";   ///< at first: the program's default, if its option has one
    bool has_default = true;  ///< whether `value` is that default
};

const std::vector<Control> controls{
    {"--robot", "Robot", "text", "Robot"},
    {"--stance", "Stance", "choice", "Robot", "", For::All, "settled"},
    {"--max-slope", "Steepest ground", "number", "Limits", "degrees"},
    {"--max-tilt", "Largest tilt on its way down", "number", "Limits", "degrees", For::All, "45"},
    {"--min-stability", "Least margin", "number", "Limits", "m"},
    {"--friction", "Friction", "number", "Limits", "", For::All, "0.8"},
    {"--lift", "Lift", "number", "Limits", "m", For::All, "0.02"},
    {"--drop", "Free fall from", "number", "Limits", "m"},
    {"--max-height", "Largest height above the ground", "number", "Limits", "m", For::All, "1"},
    {"--max-water-depth", "Deepest water that counts", "number", "Limits", "m"},
    {"--offset", "Height of a level robot above its layer", "text", "Ground", "m", For::All, "auto"},
    {"--layers", "Layers", "text", "Ground", "", For::All, "all"},
    {"--z", "Heights of the ground, LOW:HIGH", "text", "Ground", "m"},
    {"--region", "Only here", "regions", "Regions"},
    {"--keep-out", "Not here", "regions", "Regions"},
    {"--raster", "Distance between columns", "number", "Verdicts", "m", For::Layers},
    {"--yaw", "Yaw", "text", "Verdicts", "", For::Layers, "0"},
    {"--headings", "Headings all around", "integer", "Verdicts", "", For::Layers, "1"},
    {"-n", "Number of spawns", "integer", "Spawns", "", For::Spawns, "20", false},
    {"--min-distance", "Distance between spawns", "number", "Spawns", "m", For::Spawns, "0"},
    {"--clearance", "Distance from obstacles", "number", "Spawns", "m", For::Spawns, "0"},
    {"--seed", "Seed", "integer", "Spawns", "", For::Spawns, "0"},
};

/// Returns the value of a control in JSON: of the command line, or else the default.
Json value_of(const Control& control, const CLI::App& command)
{
    const CLI::Option* const option = command.get_option_no_throw(control.option);
    const bool is_given = option != nullptr && option->count() > 0;
    const std::string text = is_given ? option->results().front() : control.value;
    const std::string_view type = control.type;
    if (type == "regions") return text.starts_with('{') ? text : "";  // the page draws only GeoJSON
    if (type != "number" && type != "integer") return text;
    double number = 0;
    return CLI::detail::lexical_cast(text, number) ? Json(number) : Json();
}

Json controls_json(const CLI::App& command)
{
    Json out = Json::array();
    for (const Control& control : controls) {
        Json entry{{"option", control.option},
                   {"name", control.name},
                   {"type", control.type},
                   {"group", control.group},
                   {"unit", control.unit},
                   {"value", value_of(control, command)},
                   {"for", control.use == For::All      ? "all"
                           : control.use == For::Layers ? "layers"
                                                        : "spawns"}};
        if (const CLI::Option* const option = command.get_option_no_throw(control.option))
            entry["help"] = option->get_description();
        if (std::string_view(control.option) == "--stance") entry["choices"] = {"settled", "level"};
        out.push_back(std::move(entry));
    }
    return out;
}

/// An option of the command line, with its values.
struct GivenOption {
    std::string name;
    std::vector<std::string> words;  ///< of the command line
    bool is_input = false;           ///< it is about the map or the robot, which are in memory already
};

/// Returns the options of the command line that hold for all queries of a page: those that are no controls, and regions
/// that the page cannot draw.
std::vector<GivenOption> given_options(const CLI::App& command)
{
    const std::set<std::string> of_page{"--out",     "--serve",     "--port",  "--spawns",     "--pairs",   "--islands",
                                        "--threads", "--triangles", "--quiet", "--max-memory", "--summary", "--settle"};
    std::vector<GivenOption> out;
    for (const CLI::Option* const option : command.get_options()) {
        if (option->count() == 0 || option->get_positional() || option->get_lnames().empty()) continue;
        const std::string name = "--" + option->get_lnames().front();
        const bool is_region = name == "--region" || name == "--keep-out";
        const bool is_control = std::ranges::any_of(controls, [&](const Control& c) { return name == c.option; });
        if (of_page.contains(name) || (is_control && !is_region)) continue;
        const bool is_input = option->get_group() == help_group::changes || option->get_group() == help_group::robot;
        if (option->get_items_expected_max() == 0) {
            out.push_back({name, {name}, is_input});
            continue;
        }
        for (const std::string& value : option->results())
            if (!is_region || !value.starts_with('{')) out.push_back({name, {name, value}, is_input});
    }
    return out;
}

/// Runs commands for a page, and keeps their messages.
class PageHost : public SilentHost {
public:
    explicit PageHost(const Host& outer) : outer_(outer) { wants_update = true; }

    void notice(const std::string& text) override { notices.push_back(text); }
    void complain(const std::string& message) override { complaint = message; }
    bool is_interrupted() const override { return outer_.is_interrupted(); }

    std::vector<std::string> notices;
    std::string complaint;

private:
    const Host& outer_;
};

/// A request of the page that cannot be fulfilled.
struct Refused {
    std::string message;
};

/// Answers the requests of a page.
class LivePage {
public:
    explicit LivePage(const LiveReview& review) : review_(review), given_(given_options(review.command)) {}

    WebAnswer answer(const WebRequest& request)
    {
        if (request.method == "GET" && request.path.empty()) return {200, "text/html; charset=utf-8", page_};
        if (request.method != "POST") return {404, "text/plain", "There is only the page itself.\n"};
        try {
            const Json body = parsed(request.body);
            if (request.path == "layers") return pack_of(layers(body));
            if (request.path == "spawns") return pack_of(spawns(body));
            if (request.path == "pose") return pose_of(pose(body));
        } catch (const Refused& refused) {
            return {400, "application/json", text_of({{"message", refused.message}})};
        } catch (const std::exception& error) {  // for example, a value of another type
            return {400, "application/json", text_of({{"message", error.what()}})};
        }
        return {404, "text/plain", "The page asks only for layers, spawns and pose.\n"};
    }

    /// Makes the page. `address`: of the server.
    void make_page(const std::string& address)
    {
        const std::size_t token = address.find('/', address.find("://") + 3);
        page_ = review_.page(
            text_of({{"controls", controls_json(review_.command)}, {"address", address.substr(token)}}));
    }

private:
    struct Result {
        std::any found;
        std::vector<std::string> words;  ///< of the command line that gives the same
        double seconds = 0;
        std::vector<std::string> notices;
    };

    static std::string text_of(const Json& json) { return json.dump(-1, ' ', false, Json::error_handler_t::replace); }

    static Json parsed(const std::string& text)
    {
        const Json out = Json::parse(text, nullptr, false);
        if (!out.is_object()) throw Refused{"the request is not a JSON object"};
        return out;
    }

    /// Returns the words of the options of a request. Only the page's controls are options, and only boxes are robots,
    /// besides the robot of the command line: a page names no files.
    std::vector<std::string> words_of(const Json& options, For use) const
    {
        if (!options.is_object()) throw Refused{"the options are not a JSON object"};
        std::vector<std::string> out;
        for (const auto& [option, value] : options.items()) {
            const auto is_it = [&, &option = option](const Control& control) { return option == control.option; };
            const auto control = std::find_if(controls.begin(), controls.end(), is_it);
            if (control == controls.end()) throw Refused{option + " is not a control of the page"};
            if (option == "--robot" || (control->use != For::All && control->use != use)) continue;
            for (const Json& one : value.is_array() ? value : Json::array({value})) {
                if (one.is_structured()) throw Refused{option + " needs a text or a number"};
                const std::string text = one.is_string() ? one.get<std::string>() : one.is_null() ? "" : text_of(one);
                if (text.empty() || (control->has_default && text == control->value)) continue;
                if (std::string_view(control->type) == "regions" && text.front() != '{' && !is_box(text))
                    throw Refused{option + " of a page needs a box or GeoJSON, not the name of a file"};
                out.insert(out.end(), {option, text});
            }
        }
        return out;
    }

    std::string robot_of(const Json& options) const
    {
        const std::string robot = options.value("--robot", review_.args.robot);
        if (robot != review_.args.robot && !robot.starts_with("box:"))
            throw Refused{"Robot is \"" + robot + "\", needs box:LX,LY,LZ, or " + review_.args.robot +
                          ", the robot of the command line"};
        return robot;
    }

    /// A query of the page: a command, the options of the request, and other words of the command line.
    struct Query {
        std::string command;
        const Json& options;
        For use;
        std::vector<std::string> more = {};
    };

    static void add(std::vector<std::string>& words, const std::vector<std::string>& more)
    {
        words.insert(words.end(), more.begin(), more.end());
    }

    /// Runs a command that writes nothing, with these inputs besides the map and the robot. Options of the command line
    /// hold for it, too, unless the request has them.
    Result run(const Query& query, const std::map<std::string, std::any>& inputs = {}) const
    {
        std::vector<std::string> asked = words_of(query.options, query.use);
        add(asked, query.more);
        const std::vector<std::string> first{query.command, review_.args.map, "--robot", robot_of(query.options)};
        PageHost host(*review_.args.host);
        host.inputs = inputs;
        host.inputs[review_.args.map] = review_.map;
        host.inputs[review_.args.robot] = review_.robot;
        ChosenCommand chosen{.host = &host};
        CLI::App app;
        add_commands(app, "spawnfield " + query.command, chosen, query.command);
        const CLI::App& command = *app.get_subcommand(query.command);
        std::vector<std::string> words{"spawnfield"}, parsed = first;
        add(words, first);
        for (const GivenOption& given : given_) {
            if (std::ranges::count(asked, given.name) > 0 || command.get_option_no_throw(given.name) == nullptr)
                continue;
            add(words, given.words);
            if (!given.is_input) add(parsed, given.words);
        }
        add(words, asked);
        add(parsed, asked);
        add(parsed, {"--threads", std::to_string(review_.args.threads)});
        const auto start = std::chrono::steady_clock::now();
        try {
            app.parse(std::vector<std::string>(parsed.rbegin(), parsed.rend()));
            run_command(chosen);
        } catch (const CLI::ParseError& error) {
            const std::string unknown = unknown_option(app);
            throw Refused{unknown.empty() ? error.what() : unknown};
        } catch (const ArgumentError& error) {
            throw Refused{error.message()};
        } catch (const NothingFits& nothing) {
            throw Refused{nothing.why};
        } catch (const Interrupted&) {
            throw Refused{"spawnfield ends"};
        } catch (const std::bad_alloc&) {
            throw Refused{
                "the query needs more memory than --max-memory allows; take a larger distance between columns"};
        } catch (const std::exception& error) {
            throw Refused{error.what()};
        }
        if (!host.result.has_value()) throw Refused{host.complaint.empty() ? "nothing was found" : host.complaint};
        const std::chrono::duration<double> time = std::chrono::steady_clock::now() - start;
        return {std::move(host.result), std::move(words), time.count(), std::move(host.notices)};
    }

    Result layers(const Json& options) const
    {
        Result out = run({"review", options, For::Layers});
        out.words.insert(out.words.end(), {"-o", "review.html"});
        return out;
    }

    /// Returns an update with these poses, and the command that made them.
    Result judged(const Json& options, std::shared_ptr<const PoseTable> poses) const
    {
        Result out = run({"review", options, For::All, {"--spawns", "spawns.csv"}}, {{"spawns.csv", std::move(poses)}});
        out.words.insert(out.words.end(), {"-o", "review.html"});
        return out;
    }

    static std::shared_ptr<const PoseTable> table_of(const std::string& csv)
    {
        try {
            return std::make_shared<const PoseTable>(parse_poses(csv, "the page's poses", true));
        } catch (const FileError& error) {
            throw Refused{error.what()};
        }
    }

    Result spawns(const Json& options) const
    {
        Result sampled = run({"sample", options, For::Spawns});
        const auto* const found = std::any_cast<std::shared_ptr<const FoundSpawns>>(&sampled.found);
        if (found == nullptr) throw Refused{"no spawns were found"};
        Result out = judged(options, table_of(spawns_csv((*found)->list)));
        out.words = std::move(sampled.words);
        out.words.insert(out.words.end(), {"-o", "spawns.csv"});
        out.seconds = sampled.seconds;
        out.notices = std::move(sampled.notices);
        return out;
    }

    Result pose(const Json& body) const
    {
        const Json pose = body.value("pose", Json());
        const bool is_pose = pose.is_array() && pose.size() == 6 &&
                             std::all_of(pose.begin(), pose.end(), [](const Json& n) { return n.is_number(); });
        if (!is_pose) throw Refused{"pose needs six numbers: x, y, z, roll, pitch, yaw; m and rad"};
        std::string row = text_of(pose);
        row = row.substr(1, row.size() - 2);
        return judged(body.value("options", Json::object()), table_of("x,y,z,roll,pitch,yaw\n" + row + "\n"));
    }

    static const std::string& pack_in(const Result& result)
    {
        const auto* const update = std::any_cast<std::shared_ptr<const FoundUpdate>>(&result.found);
        if (update == nullptr) throw Refused{"nothing was found"};
        return (*update)->pack;
    }

    /// A pack begins with a mark, the length of its JSON text, and this text.
    static constexpr std::size_t mark = 8, begin = 12;
    static std::uint32_t json_length(const std::string& pack)
    {
        std::uint32_t out = 0;
        std::memcpy(&out, pack.data() + mark, sizeof out);
        return out;
    }
    static Json json_in(const std::string& pack) { return Json::parse(pack.substr(begin, json_length(pack))); }

    /// Returns the pack that was found. Its JSON also gets the command line that makes the same, the seconds, and the
    /// notices.
    static WebAnswer pack_of(const Result& result)
    {
        const std::string& pack = pack_in(result);
        Json head = json_in(pack);
        head["command"] = shell_line(result.words);
        head["seconds"] = result.seconds;
        head["notices"] = result.notices;
        const std::string text = text_of(head);
        const auto length = std::uint32_t(text.size());
        return {200, "application/octet-stream",
                pack.substr(0, mark) + std::string(reinterpret_cast<const char*>(&length), sizeof length) + text +
                    pack.substr(begin + json_length(pack))};
    }

    /// Returns what an update says about its only pose.
    WebAnswer pose_of(const Result& result) const
    {
        const Json all = json_in(pack_in(result)), list = all.at("spawns").at(0);
        const std::vector<Part>& parts = review_.map->geometry.parts();
        const std::size_t hit = list.at("hits").at(0);
        Json out{{"verdict", to_string(Verdict(list.at("verdicts").at(0).get<int>()))},
                 {"reason", list.at("reasons").at(0)},
                 {"hit", hit == 0              ? Json()
                         : hit <= parts.size() ? Json(parts[hit - 1].name)
                                               : Json("occupancy")}};
        for (const auto& [from, to] :
             {std::pair("poses", "pose"), std::pair("tilt", "tilt"), std::pair("margin", "margin"),
              std::pair("clearance", "clearance"), std::pair("contacts", "contacts")})
            out[to] = list.at(from).at(0);
        return {200, "application/json", text_of(out)};
    }

    const LiveReview& review_;
    const std::vector<GivenOption> given_;
    std::string page_;
};

}  // namespace

void serve_review(const LiveReview& review)
{
    LivePage page(review);
    Host& host = *review.args.host;
    serve_locally({.port = review.port,
                   .answer = [&](const WebRequest& request) { return page.answer(request); },
                   .on_start =
                       [&](const std::string& address) {
                           page.make_page(address);
                           host.write("Open " + address + " in a browser. Ctrl-C ends.\n");
                           host.flush();
                       },
                   .stop = [&] { return host.is_interrupted(); }});
}

}  // namespace spawnfield::cli
