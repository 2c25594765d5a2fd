#pragma once

#include "experiments.h"
#include "pictures.h"

namespace experiments {

struct Results {
    std::vector<Run> runs;
    std::vector<Milestone> milestones;
    std::vector<ColumnFinds> column_finds;
    std::vector<Picture> cases, spawns;
    double total_seconds = 0;
};

/// Returns a CSV table with the columns
/// test,environment,robot,obstacle,mode,step,repetition,positions,valid,invalid,aerial,exact_checks,seconds.
std::string runs_csv(const std::vector<Run>& runs);
/// Returns a CSV table with the columns environment,distance_check,repetition,found,seconds.
std::string milestones_csv(const std::vector<Milestone>& milestones);
/// Returns a CSV table with the columns x,y,in_2d,in_3d,in_3d_snapped.
std::string column_finds_csv(const std::vector<ColumnFinds>& finds);
/// Returns the figures of the thesis as a CSV table, with those columns of runs_csv that the thesis has; mode is
/// "thesis".
std::string thesis_csv();

/// Returns the report as Markdown. It links to pictures and plots in the folder `pictures` beside it.
std::string report(const Settings& settings, const std::vector<const Environment*>& environments,
                   const Results& results, const std::string& command, const std::string& pictures);

}  // namespace experiments
