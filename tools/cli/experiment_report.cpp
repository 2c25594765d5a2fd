#include "experiment_report.h"

#include "common/machine.h"
#include "common/statistics.h"
#include "numbers.h"

#include <cstdio>
#include <span>

namespace spawnfield::cli {
namespace {

using Runs = std::span<const ExperimentRun>;

std::string number_or_nothing(const std::optional<double>& value) { return value ? number(*value) : ""; }

/// Visits the verdicts with `valid` first, as in summary lines.
template <class Visit>
void for_each_verdict(const Visit& visit)
{
    for (auto verdict = all_verdicts.rbegin(); verdict != all_verdicts.rend(); ++verdict) visit(*verdict);
}

std::uint64_t poses_of(const ExperimentRun& run) { return run.counts.total(); }

/// Returns six digits for the table; the CSV file has all digits.
std::string six_digits(double value)
{
    char text[32];
    std::snprintf(text, sizeof text, "%.6g", value);
    return text;
}

/// Returns the runs from `first` on that have the same step.
Runs runs_of_step(Runs all, std::size_t first)
{
    std::size_t end = first + 1;
    while (end < all.size() && all[end].step == all[first].step && all[end].step_z == all[first].step_z) ++end;
    return all.subspan(first, end - first);
}

std::string table_head(bool is_raster, bool is_3d)
{
    std::string names, rule;
    const auto column = [&](const std::string& name) {
        names += "| " + name + " ";
        rule += "|--:";
    };
    if (is_raster) column("step (m)");
    if (is_3d) column("step z (m)");
    column("checks");
    for_each_verdict([&](Verdict verdict) { column(to_string(verdict)); });
    column("exact checks");
    column("mean time (s)");
    column("variance (s2)");
    return names + "|\n" + rule + "|\n";
}

std::string table_row(Runs runs)
{
    std::string text;
    const auto cell = [&](const std::string& value) { text += "| " + value + " "; };
    if (runs[0].step) cell(number(*runs[0].step));
    if (runs[0].step_z) cell(number(*runs[0].step_z));
    cell(number(tools::mean(runs, poses_of)));
    for_each_verdict([&](Verdict verdict) {
        cell(number(tools::mean(runs, [&](const ExperimentRun& run) { return run.counts[verdict]; })));
    });
    cell(number(tools::mean(runs, &ExperimentRun::exact_checks)));
    cell(six_digits(tools::mean(runs, &ExperimentRun::seconds)));
    cell(runs.size() > 1 ? six_digits(tools::sample_variance(runs, &ExperimentRun::seconds)) : "");
    return text + "|\n";
}

}  // namespace

std::string experiment_csv(const std::vector<ExperimentRun>& runs)
{
    std::string text = "run,step,step_z,poses";
    for_each_verdict([&](Verdict verdict) { text += std::string(",") + to_string(verdict); });
    text += ",exact_checks,seconds,seed\n";
    for (const ExperimentRun& run : runs) {
        text += std::to_string(run.number) + "," + number_or_nothing(run.step) + "," + number_or_nothing(run.step_z) +
                "," + std::to_string(poses_of(run));
        for_each_verdict([&](Verdict verdict) { text += "," + std::to_string(run.counts[verdict]); });
        text += "," + std::to_string(run.exact_checks) + "," + number(run.seconds) + "," +
                (run.seed ? std::to_string(*run.seed) : "") + "\n";
    }
    return text;
}

std::string experiment_markdown(const Experiment& experiment)
{
    const Runs runs = experiment.runs;
    const std::size_t repeated = runs_of_step(runs, 0).size();
    std::string text = "# Experiment\n\n```\n" + experiment.command_line + "\n```\n\n";
    text += "- map " + experiment.map + ", hash " + experiment.map_hash + "\n";
    text += "- robot " + experiment.robot + "\n";
    text += "- " +
            (experiment.seed ? "seed " + std::to_string(*experiment.seed) + ", one more for each further run"
                             : "no seed: rasters draw nothing") +
            "\n";
    text += "- " + tools::machine() + "; " + counted(experiment.threads, "thread") + "\n\n";
    text += repeated > 1
                ? "Each row: means of " + counted(repeated, "run") + ", and the sample variance of their times. "
                : "Each row: one run. ";
    text += "Times are those of the query alone; the very first one also reads\nwhat it needs of the map.\n\n" +
            table_head(runs[0].step.has_value(), runs[0].step_z.has_value());
    for (std::size_t first = 0; first < runs.size();) {
        const Runs same = runs_of_step(runs, first);
        text += table_row(same);
        first += same.size();
    }
    if (experiment.has_page)
        text += std::string("\n[review.html](review.html) shows the world and the ") +
                (experiment.seed ? "spawns of the last run" : "finest raster") + ".\n";
    return text;
}

}  // namespace spawnfield::cli
