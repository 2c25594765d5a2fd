#pragma once

#include "robot_args.h"
#include "spelling.h"

#include <spawnfield/error.h>
#include <spawnfield/output_file.h>
#include <spawnfield/poses.h>
#include <spawnfield/query.h>

#include <CLI/CLI.hpp>

#include <functional>
#include <optional>
#include <string>
#include <vector>

namespace spawnfield::cli {

enum ExitStatus {
    done = 0,
    failure = 1,
    wrong_usage = 2,
    fewer_found = 3,
    not_valid = 3,  ///< check --require-valid
    input_refused = 4,
    interrupted = 130
};

/// The user pressed Ctrl-C; nothing was written.
struct Interrupted {};

/// No pose can be valid, and `why`: the command ends with fewer_found.
struct NothingFits {
    std::string why;
};

/// Greatest value of --threads.
inline constexpr int most_threads = 1024;

/// Options that every command has.
struct CommonArgs {
    int threads = 0;
    bool quiet = false;
    std::string summary;
    bool allow_empty = false;  ///< files of poses may have none; set by --allow-empty
};
void add_common(CLI::App& command, CommonArgs& args);

/// --allow-empty, for commands that read poses.
void add_allow_empty(CLI::App& command, CommonArgs& args);

/// Options of every command that asks a map about a robot.
struct QueryArgs : CommonArgs, RobotArgs {
    std::string map, robot, collision = "geometry";
    double max_height = 1.0;
    bool exhaustive = false;
    double max_water_depth = std::numeric_limits<double>::infinity();
    std::optional<double> max_slope;  ///< degrees
};
void add_query(CLI::App& command, QueryArgs& args);

/// Of an option's text: not "", as of "$UNSET".
CLI::Validator not_empty();

/// Throws ArgumentError "--option REASON" if one of the options was given.
void refuse(const CLI::App& command, const std::vector<std::string>& options, const std::string& reason);

/// A notice for each of the options that was given and says nothing here.
void tell_idle(const CommonArgs& args, const CLI::App& command, const std::vector<std::string>& options,
               const std::string& reason);

/// Words for people: notices, one at a time on standard error, unless --quiet.
void notice(const CommonArgs& args, const std::string& text);

/// The same for several: those of one kind are printed once, with a count (notices.h).
void notices(const CommonArgs& args, const std::vector<std::string>& texts);

/// The shortest text that reads back to the same double.
std::string number(double value);

/// "1 layer", "2 layers".
std::string counted(std::uint64_t count, const std::string& noun);

/// A bar on standard error while it is a terminal; without one it only notices Ctrl-C.
Progress progress_bar(const CommonArgs& args, const std::string& label);
void clear_progress_bar();

/// Finite numbers with `separator` between them. Throws ArgumentError.
std::vector<double> parse_numbers(const std::string& option, const std::string& text, char separator = ',');
/// "x0,y0,z0,x1,y1,z1", or, where that is allowed, "x0,y0,x1,y1" at all heights. Throws ArgumentError.
Bounds parse_bounds(const std::string& option, const std::string& text, bool flat_allowed);
/// As parse_bounds reads it: 6 numbers, or of 2 axes 4.
std::string bounds_text(const Bounds& bounds, int axes);
LayerChoice parse_layers(const std::string& text);  ///< all|top|bottom|N
double parse_positive(const std::string& option, double value);
double parse_finite(const std::string& option, double value, const std::string& unit);
/// "--step is 0, needs > 0", to be thrown.
ArgumentError bad_value(const std::string& option, double value, const std::string& limit);

/// What a run did. Written as one line and, with --summary, as JSON (DESIGN.md, Commands).
class Summary {
public:
    /// Throws OutputError if the JSON will not be written: before all work, so that none is half done.
    Summary(std::string command, const CommonArgs& args);

    void lap(const std::string& stage);  ///< seconds since the last lap go to this stage
    void set_counts(const VerdictCounts& counts);
    double seconds_of(const std::string& stage) const;
    double elapsed() const;  ///< seconds since the start
    unsigned threads() const;

    std::uint64_t poses = 0, exact_checks = 0, seed = 0;
    std::string map_hash;
    ExactTime exact_time;                                     ///< for JudgeOptions
    std::vector<std::string> extra;                           ///< further words for the line, in front
    std::optional<double> offset;                             ///< m, of poses on layers
    std::vector<std::pair<std::string, double>> more_stages;  ///< a bake's own
    struct Fullness {
        bool is_full;
        double undecided_area;  // m2
    };
    std::optional<Fullness> fullness;  ///< of a sample
    std::vector<std::pair<std::string, std::uint64_t>>
        draws;  ///< of a sample or search: how many there were, and how many were dropped why

    void finish();  ///< tells standard error and writes the JSON

private:
    std::string line(double total) const;
    std::string json(double total) const;

    std::string command_;
    const CommonArgs& args_;
    std::optional<OutputFile> file_;
    bool has_counts_ = false;
    VerdictCounts counts_;
    std::vector<std::pair<std::string, double>> seconds_;
    double start_, last_;
};

/// Poses of a CSV file, or of standard input if it is `-`. Prints the file's notices.
PoseTable open_poses(const CommonArgs& args, const std::string& file);

/// The map and the robot of a command.
struct Session {
    Map map;
    Robot robot;
    std::optional<Judge> judge;  ///< none without --robot, where a command allows that
};
/// Throws ArgumentError for limits out of range, before anything is read. The time of exact checks goes to the summary.
Session open_session(const QueryArgs& args, Summary& summary);

/// A notice where an answer is plain before it is asked for: the region lies off the map, no column has that layer.
void tell_if_off_map(const CommonArgs& args, const Map& map, const std::string& option, const Bounds& bounds);
void tell_if_no_layer(const CommonArgs& args, const Map& map, const LayerChoice& layers);

/// `-o FILE`, whole or not at all, or standard output where the file is empty or `-`. `then` runs when all is written
/// but the file has not its name yet: it gets that only if `then` succeeds too.
void write_output(
    const std::string& file, const std::function<void(const std::function<void(std::string_view)>&)>& writer,
    const std::function<void()>& then = [] {});

/// Each adds its command to the app; `run` is set when it is chosen.
using Run = std::function<int()>;
void add_bake(CLI::App& app, Run& run);
void add_info(CLI::App& app, Run& run);
void add_check(CLI::App& app, Run& run);
void add_raster(CLI::App& app, Run& run);
void add_search(CLI::App& app, Run& run);
void add_sample(CLI::App& app, Run& run);
void add_heatmap(CLI::App& app, Run& run);
void add_export(CLI::App& app, Run& run);
void add_experiment(CLI::App& app, const std::string& command_line, Run& run);

}  // namespace spawnfield::cli
