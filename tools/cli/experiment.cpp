#include "angle.h"
#include "command.h"
#include "experiment_report.h"
#include "messages.h"
#include "numbers.h"
#include "raster_args.h"
#include "spawn_advice.h"
#include "spawn_args.h"

#include <spawnfield/error.h>
#include <spawnfield/output_file.h>
#include <spawnfield/output_folder.h>
#include <spawnfield/review.h>

#include <cmath>

namespace spawnfield::cli {
namespace {

constexpr std::array experiment_files{"experiment.csv", "experiment.md", "review.html"};

struct ExperimentArgs : RasterArgs {
    DrawArgs draws;
    bool search = false, html = false;
    long long runs = 1;
    std::string steps, steps_z, out, command_line;
};

/// Reads "FROM:TO:BY" with TO included (to 1e-9 of BY), or one number; m. Steps are rounded to 1e-9 m, so that
/// 0.1:0.5:0.1 contains 0.3 and not a double next to it. Throws ArgumentError.
std::vector<double> parse_steps(const std::string& option, const std::string& text)
{
    constexpr double most = 10000;
    const std::string form = ", needs FROM:TO:BY, for example 0.5:2:0.5, or one number, m";
    const std::vector<double> v = parse_numbers(option, text, ':', form);
    if (v.size() == 1) return {parse_positive(option, v[0])};
    if (v.size() != 3) throw ArgumentError(option + " is \"" + text + "\"" + form);
    const double from = parse_positive(option + ": FROM", v[0]), to = v[1], by = parse_positive(option + ": BY", v[2]);
    if (to < from) throw bad_value(option + ": TO", to, "at least FROM");
    const double count = std::floor((to - from) / by + 1e-9) + 1;
    if (!(count <= most)) throw bad_value(option + ": number of steps", count, "at most " + number(most));
    std::vector<double> out{from};
    for (int i = 1; i < int(count); ++i) out.push_back(std::round((from + i * by) * 1e9) / 1e9);
    return out;
}

/// Returns pairs of steps between columns and between heights. Without --steps-z the second one is 0: as between
/// columns.
std::vector<std::pair<double, double>> step_pairs(const ExperimentArgs& args)
{
    const std::vector<double> across = parse_steps("--steps", args.steps);
    const std::vector<double> up = args.steps_z.empty() ? std::vector<double>{0}
                                                        : parse_steps("--steps-z", args.steps_z);
    if (up.size() != 1 && up.size() != across.size())
        throw ArgumentError("--steps-z has " + counted(up.size(), "step") +
                            ", needs 1 or as many as --steps: " + std::to_string(across.size()));
    std::vector<std::pair<double, double>> out;
    for (std::size_t i = 0; i < across.size(); ++i) out.emplace_back(across[i], up[up.size() == 1 ? 0 : i]);
    return out;
}

void check_usage(const ExperimentArgs& args, const CLI::App& command)
{
    if (args.runs < 1) throw bad_value("--runs", double(args.runs), ">= 1");
    if (args.runs > 1000000) throw bad_value("--runs", double(args.runs), "at most 1000000");
    if (args.html) {
        require_review_page();
        if (args.dims == 3) throw ArgumentError("--html needs --dims 2 or --search: a page shows poses on the ground");
    }
    if (args.search) {
        refuse(command,
               {"--dims", "--steps", "--steps-z", "--offset", "--layers", "--floor", "--no-height-check", "--snap"},
               "is only for rasters, not for --search");
        if (command.count("-n") == 0) throw ArgumentError("--search needs -n, the number of spawns");
        return;
    }
    refuse(command, {"-n", "--min-distance", "--max-failures", "--seed"}, "needs --search");
    if (command.count("--dims") == 0) throw ArgumentError("--dims is missing; give --dims 2, --dims 3 or --search");
    if (args.steps.empty()) throw ArgumentError("--steps is missing; give for example --steps 0.5:2:0.5, or --search");
    if (args.dims == 2)
        notice_no_effect(args, command, {"--steps-z"}, "it is only for --dims 3; in 2D each pose stands on a layer");
}

/// Returns the progress of one run as the share of all runs.
Progress share_of_runs(const Progress& whole, std::size_t done, std::size_t all)
{
    return [=](double share) { whole((double(done) + share) / double(all)); };
}

/// The command's stages: reads the options, then the map, then does run after run.
class ExperimentCommand {
public:
    ExperimentCommand(const ExperimentArgs& args, const CLI::App& command, Summary& summary)
        : args_(args), command_(command), summary_(summary)
    {
        check_usage(args, command);
        if (args.search)
            prepare_searches();
        else
            prepare_rasters();
    }

    Ending run()
    {
        OutputFolder folder(args_.out, holds_only(experiment_files, "former experiment"));
        session_ = open_session(args_, summary_);
        if (args_.search) {
            search_.bounds = with_heights(search_.bounds, heights_of(args_.ground, search_.bounds, "--bounds"),
                                          session_.map);
            notice_if_off_map(args_, session_.map, "--bounds", search_.bounds);
            notice_about_area(args_, session_.map, search_.area);
            if (args_.is_settled()) choose_offset(args_, std::nullopt, session_.robot, summary_);
        } else {
            complete(raster_, args_, session_, summary_);
        }
        notices_about_stance(args_, command_, session_.robot);
        notice_about_heading(args_, session_.map, args_.search ? search_.heading : raster_.heading);
        summary_.lap("load");
        std::vector<ExperimentRun> runs = args_.search ? run_searches() : run_rasters();
        summary_.lap("query");
        write(folder, std::move(runs));
        return finish();
    }

private:
    void prepare_rasters()
    {
        raster_ = raster_options(args_, command_);
        steps_ = step_pairs(args_);
    }

    void prepare_searches()
    {
        search_ = search_options(args_, args_.draws, args_.bounds, "experiment", !args_.ground.z.empty());
        const YawChoice yaw = parse_yaw_choice(args_, args_.yaw, args_.is_settled(), true);
        search_.random_yaw = yaw.is_random;
        search_.yaw = yaw.yaw;
        search_.heading = yaw.rule;
        search_.stance = args_.stance();
        search_.area = read_area(args_, args_.area);
    }

    std::vector<ExperimentRun> run_rasters()
    {
        std::vector<ExperimentRun> out;
        const std::size_t all = steps_.size() * std::size_t(args_.runs);
        const Progress whole = raster_.progress;
        for (const auto& [step, step_z] : steps_)
            for (int number = 1; number <= args_.runs; ++number) {
                RasterOptions options = raster_;
                options.step = step;
                options.step_z = step_z;
                options.progress = share_of_runs(whole, out.size(), all);
                const double start = summary_.elapsed();
                RasterResult result = raster(*session_.judge, options);
                const double seconds = summary_.elapsed() - start;
                const std::optional<double> up = options.dims == 3 ? std::optional(result.grid.step_z) : std::nullopt;
                out.push_back({number, step, up, std::nullopt, result.counts, result.exact_checks, seconds});
                if (args_.html && (page_.rasters.empty() || step < page_.rasters[0].grid.step))
                    page_.rasters = {std::move(result)};
            }
        return out;
    }

    std::vector<ExperimentRun> run_searches()
    {
        std::vector<ExperimentRun> out;
        const Progress whole = search_.progress;
        for (int number = 1; number <= args_.runs; ++number) {
            SearchOptions options = search_;
            options.seed = search_.seed + std::uint64_t(number - 1);
            options.progress = share_of_runs(whole, out.size(), std::size_t(args_.runs));
            const double start = summary_.elapsed();
            const SpawnList list = search(*session_.judge, options);
            out.push_back({number, {}, {}, options.seed, list.counts, list.exact_checks, summary_.elapsed() - start});
            short_runs_ += list.spawns.size() < options.count;
            if (args_.html && number == args_.runs)
                page_.spawns = {{"the last run", parse_poses(spawns_csv(list), "the last run", true)}};
        }
        return out;
    }

    void write(OutputFolder& folder, std::vector<ExperimentRun> runs)
    {
        clear_progress_bar(args_);
        std::uint64_t exact_checks = 0;
        for (const ExperimentRun& run : runs) {
            counts_ += run.counts;
            exact_checks += run.exact_checks;
        }
        summary_.set_verdicts(counts_, exact_checks);
        Experiment experiment{args_.command_line,  session_.map.name,  session_.map.hash,
                              session_.robot.name, summary_.threads(), {},
                              std::move(runs)};
        if (args_.search) experiment.seed = search_.seed;
        experiment.has_page = args_.html;
        write_file_atomically(folder.path() / "experiment.csv", experiment_csv(experiment.runs));
        write_file_atomically(folder.path() / "experiment.md", experiment_markdown(experiment));
        if (args_.html) write_page(folder.path() / "review.html");
        stop_if_interrupted(args_);
        folder.commit();
        notices(args_, folder.notices());
    }

    /// Writes the review page with the finest raster, or with the spawns of the last search.
    void write_page(const std::filesystem::path& file)
    {
        page_.command = args_.command_line;
        page_.floors = floors_of(session_.map);
        page_.stance = args_.stance();
        const RunOptions run{.threads = args_.threads, .progress = progress_bar(args_, "review")};
        OutputFile out(file);
        write_review(
            *session_.judge, page_, [&](std::string_view piece) { out.write(piece); }, run);
        out.commit();
    }

    Ending finish()
    {
        const std::string runs = counted(std::uint64_t(args_.runs), "run");
        summary_.extra = {args_.out, args_.search ? runs : runs + " of " + counted(steps_.size(), "step")};
        summary_.seed = args_.search ? search_.seed : 0;
        if (short_runs_ == 0) return {};
        const std::string advice = spawn_advice(args_, args_.ground,
                                                {.is_search = true,
                                                 .min_distance = search_.min_distance,
                                                 .has_region = !search_.area.is_everywhere(),
                                                 .counts = counts_});
        return {.status = fewer_found,
                .notice = counted(short_runs_, "run") + " of " + std::to_string(args_.runs) + " found fewer than " +
                          counted(search_.count, "spawn") + "; " + advice + " may give more"};
    }

    const ExperimentArgs& args_;
    const CLI::App& command_;
    Summary& summary_;
    RasterOptions raster_;  ///< without the steps
    SearchOptions search_;  ///< of the first run
    std::vector<std::pair<double, double>> steps_;
    Session session_;
    VerdictCounts counts_;  ///< of all runs
    ReviewContents page_;   ///< with --html
    std::uint64_t short_runs_ = 0;
};

Ending run_experiment(const ExperimentArgs& args, const CLI::App& command, Summary& summary)
{
    return ExperimentCommand(args, command, summary).run();
}

}  // namespace

void add_experiment(CLI::App& app, const std::string& command_line, ChosenCommand& chosen)
{
    auto args = std::make_shared<ExperimentArgs>();
    args->command_line = command_line;
    CLI::App& command = *app.add_subcommand(
        "experiment", "Rasters of many steps, or random searches of many seeds, with counts and times");
    add_map_and_robot(command, *args);
    command
        .add_option("--out,-o", args->out,
                    "Folder to write: experiment.csv, experiment.md, and with --html review.html; an older experiment "
                    "there is replaced")
        ->required()
        ->check(not_empty());
    command.add_flag("--html", args->html,
                     "Also write a page that shows the world in 3D, as `review` does: with the finest raster, or the "
                     "spawns of the last search");
    command.add_option("--runs", args->runs, "Number of runs of each step, or of the search (default 1)");
    add_dims(command, *args);
    command.add_option("--steps", args->steps,
                       "Distances between columns, m: FROM:TO:BY with TO included, or one number");
    command.add_option("--steps-z", args->steps_z,
                       "3D: distances between heights, m: one for each of --steps, or one for all (default: --steps)");
    command.add_flag("--search", args->search,
                     "Random searches instead of rasters: the first with --seed, each further one with the next seed");
    start_group(command, "Searches");
    add_draws(command, args->draws);
    add_max_failures(command, args->draws);
    add_raster_query(command, *args);
    command.get_option("--yaw")->description("Yaw of all poses: " + yaw_help + "; with --search also random; for " +
                                             heading_help + " (default 0)");
    command.footer(
        "Example:\n"
        "  spawnfield experiment /tmp/training --robot box:0.99,0.67,0.39 --dims 2 --steps 0.5:2:0.5 --offset 0.5 "
        "--runs 3 -o /tmp/box_steps\n"
        "  spawnfield experiment /tmp/training --robot box:0.99,0.67,0.39 --search -n 20 --min-distance 1.5 --runs 5 "
        "-o /tmp/box_searches");
    set_work(command, args, chosen, run_experiment);
}

}  // namespace spawnfield::cli
