#include "thesis_output.h"

#include "messages.h"
#include "numbers.h"

namespace spawnfield::cli {

Settings query_settings(const std::string& command, const QueryArgs& args, const Session& session)
{
    Settings out{{"Command", command},
                 {"Version", version()},
                 {"Map", session.map.name},
                 {"Map hash", session.map.hash},
                 {"Robot", session.robot.name}};
    for (const std::string& change : session.map.changes) out.emplace_back("Map change", change);
    for (const auto& [joint, value] : session.robot.joints)
        out.emplace_back("Joint " + joint + " (rad or m)", number(value));
    if (session.robot.mesh_parts != 1) out.emplace_back("Mesh parts", std::to_string(session.robot.mesh_parts));
    out.emplace_back("Collision", args.collision);
    out.emplace_back("Exhaustive", args.exhaustive ? "yes" : "no");
    if (!args.is_settled()) return out;
    const StandLimits& limits = session.judge->options().stand;
    out.emplace_back("Stance", "settled");
    out.emplace_back("Lift (m)", number(limits.lift));
    out.emplace_back("Max slope (rad)", number(limits.max_slope));
    out.emplace_back("Max tilt (rad)", number(limits.max_tilt));
    out.emplace_back("Min stability (m)", number(*limits.min_stability));
    out.emplace_back("Friction", number(limits.friction));
    if (limits.drop) out.emplace_back("Drop (m)", number(*limits.drop));
    return out;
}

std::unique_ptr<OutputFolder> thesis_folder(const std::string& out)
{
    if (out.empty() || out == "-") throw ArgumentError("--format thesis needs -o FOLDER");
    return std::make_unique<OutputFolder>(out, holds_only(thesis_files, "thesis result"));
}

void write_thesis(const CommonArgs& args, OutputFolder& folder, const Settings& settings, const VerdictCounts& counts,
                  const Summary& summary,
                  const std::function<ThesisCounts(const std::filesystem::path&)>& write_locations,
                  const std::function<void()>& then)
{
    clear_progress_bar(args);
    const ThesisCounts written = write_locations(folder.path());
    write_file_atomically(folder.path() / "Stats.txt", thesis_stats(settings, counts, written));
    write_file_atomically(folder.path() / "RunTime.txt", "Load (s): " + number(summary.seconds_of("load")) +
                                                             "\nQuery (s): " + number(summary.seconds_of("query")) +
                                                             "\nTotal (s): " + number(summary.elapsed()) + "\n");
    then();
    stop_if_interrupted(args);
    folder.commit();
    notices(args, folder.notices());
}

}  // namespace spawnfield::cli
