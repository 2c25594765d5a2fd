#include "arena.h"

#include <spawnfield/poses.h>

#include <nlohmann/json.hpp>

#include <cmath>
#include <map>
#include <set>
#include <sstream>

namespace fs = std::filesystem;

namespace {

const std::string& husky = husky_option;

/// Returns the summary of a run of the program.
nlohmann::json summary(const Arena& arena, const std::string& arguments)
{
    CHECK(arena(arguments + " --summary .s.json").status == 0);
    return nlohmann::json::parse(bytes_of(arena / ".s.json"));
}

using Row = std::map<std::string, std::string>;

std::vector<std::string> split(const std::string& line, char separator)
{
    std::vector<std::string> out;
    std::istringstream stream(line + separator);
    for (std::string field; std::getline(stream, field, separator);) out.push_back(field);
    return out;
}

std::vector<Row> rows_of(const fs::path& file)
{
    std::istringstream stream(bytes_of(file));
    std::string line;
    std::getline(stream, line);
    const std::vector<std::string> names = split(line, ',');
    std::vector<Row> out;
    while (std::getline(stream, line)) {
        const std::vector<std::string> fields = split(line, ',');
        REQUIRE(fields.size() == names.size());
        out.emplace_back();
        for (std::size_t i = 0; i < names.size(); ++i) out.back()[names[i]] = fields[i];
    }
    return out;
}

/// Returns the cells of all rows of the only table in a file.
std::vector<std::vector<std::string>> table_of(const fs::path& file)
{
    std::istringstream stream(bytes_of(file));
    std::vector<std::vector<std::string>> out;
    for (std::string line; std::getline(stream, line);) {
        if (!line.starts_with("| ")) continue;
        out.emplace_back();
        for (const std::string& cell : split(line.substr(2, line.size() - 3), '|')) {
            const std::size_t first = cell.find_first_not_of(' ');
            out.back().push_back(
                first == std::string::npos ? "" : cell.substr(first, cell.find_last_not_of(' ') + 1 - first));
        }
    }
    return out;
}

/// Checks that the row of a run agrees with the summary of the single command.
void check_counts(const Row& row, const nlohmann::json& summary)
{
    CAPTURE(row.at("run"), row.at("step"), row.at("step_z"));
    CHECK(row.at("poses") == summary["poses"].dump());
    CHECK(row.at("exact_checks") == summary["exact_checks"].dump());
    for (const auto& [verdict, count] : summary["counts"].items()) CHECK(row.at(verdict) == count.dump());
    CHECK(std::stod(row.at("seconds")) > 0);
}

}  // namespace

TEST_CASE("an experiment with rasters has the counts of raster for each step, in every run")
{
    const Arena arena;
    const std::string options[] = {"--dims 2 --offset 0.3 --yaw 0.4",
                                   "--dims 3 --bounds -5,-5,-1,5,5,3 --max-height 0.5",
                                   "--dims 3 --snap --layers top --offset 0.2",
                                   "--dims 3 --no-height-check --bounds 0,0,0,3,3,2",
                                   "--dims 2 --exhaustive",
                                   "--dims 2 --settle --yaw 0.4 --max-slope 9",
                                   "--dims 2 --stance settled --yaw any:3 --bounds -5,-5,5,5",
                                   "--dims 2 --region -5,-5,3,4 --keep-out -1,-1,1,1"};
    for (const std::string& option : options) {
        INFO(option);
        const ProgramRun run = arena("experiment map --steps 0.7:1.3:0.3 --runs 2 -o out " + option + husky);
        CHECK(run.status == 0);
        CHECK(run.out.empty());
        CHECK_THAT(run.err, Contains("spawnfield experiment: out; 2 runs of 3 steps; "));
        const std::vector<Row> rows = rows_of(arena / "out/experiment.csv");
        REQUIRE(rows.size() == 6);
        const bool is_3d = option.find("--dims 3") != std::string::npos;
        for (std::size_t i = 0; i < rows.size(); ++i) {
            CHECK(rows[i].at("run") == std::to_string(i % 2 + 1));
            CHECK(rows[i].at("step") == (i < 2 ? "0.7" : i < 4 ? "1" : "1.3"));
            CHECK(rows[i].at("step_z") == (is_3d ? rows[i].at("step") : ""));
            CHECK(rows[i].at("seed").empty());
            check_counts(rows[i],
                         summary(arena, "raster map -o /dev/null " + option + " --step " + rows[i].at("step") + husky));
        }
    }
}

TEST_CASE("--steps-z has one step for all, or one for each of --steps")
{
    const Arena arena;
    const auto pairs = [&](const std::string& steps) {
        CHECK(arena("experiment map --dims 3 -o out " + steps + husky).status == 0);
        std::vector<std::string> out;
        for (const Row& row : rows_of(arena / "out/experiment.csv")) {
            out.push_back(row.at("step") + " x " + row.at("step_z"));
            check_counts(row, summary(arena, "raster map --dims 3 -o /dev/null --step " + row.at("step") +
                                                 " --step-z " + row.at("step_z") + husky));
        }
        return out;
    };
    CHECK(pairs("--steps 2:3:0.5 --steps-z 0.25") == std::vector<std::string>{"2 x 0.25", "2.5 x 0.25", "3 x 0.25"});
    CHECK(pairs("--steps 2:3:0.5 --steps-z 0.1:0.3:0.1") ==
          std::vector<std::string>{"2 x 0.1", "2.5 x 0.2", "3 x 0.3"});
    CHECK(pairs("--steps 2:2.9:0.5") == std::vector<std::string>{"2 x 2", "2.5 x 2.5"});
    CHECK(pairs("--steps 4") == std::vector<std::string>{"4 x 4"});
    CHECK(arena("experiment map --dims 2 --steps 2 --steps-z 1 -o out" + husky)
              .err.starts_with("notice: --steps-z has no effect: "));
}

TEST_CASE("the report of an experiment has a row per step with mean and sample variance, and names command and machine")
{
    const Arena arena;
    CHECK(arena("experiment map --dims 2 --steps 1:2:1 --runs 4 -o out --threads 2" + husky).status == 0);
    const std::vector<Row> rows = rows_of(arena / "out/experiment.csv");
    const auto table = table_of(arena / "out/experiment.md");
    REQUIRE(table.size() == 3);
    CHECK(table[0] == std::vector<std::string>{"step (m)", "checks", "valid", "unreachable", "obstructed", "unstable",
                                               "steep", "collision", "submerged", "off_terrain", "aerial", "outside",
                                               "exact checks", "mean time (s)", "variance (s2)"});
    for (std::size_t step = 0; step < 2; ++step) {
        double sum = 0, squares = 0;
        for (std::size_t i = 4 * step; i < 4 * step + 4; ++i) sum += std::stod(rows[i].at("seconds"));
        for (std::size_t i = 4 * step; i < 4 * step + 4; ++i)
            squares += std::pow(std::stod(rows[i].at("seconds")) - sum / 4, 2);
        const std::vector<std::string>& cells = table[step + 1];
        CHECK(cells[0] == rows[4 * step].at("step"));
        CHECK(cells[1] == rows[4 * step].at("poses"));
        CHECK(cells[2] == rows[4 * step].at("valid"));
        CHECK(cells[12] == rows[4 * step].at("exact_checks"));
        CHECK(std::stod(cells[13]) == Approx(sum / 4).epsilon(1e-4));
        CHECK(std::stod(cells[14]) == Approx(squares / 3).epsilon(1e-4));
    }
    const std::string text = bytes_of(arena / "out/experiment.md");
    CHECK_THAT(text,
               Contains("\nspawnfield experiment map --dims 2 --steps 1:2:1 --runs 4 -o out --threads 2 --robot "));
    CHECK_THAT(text, Contains(" core"));
    CHECK_THAT(text, Contains("; 2 threads\n"));
    CHECK_THAT(text, Contains("- spawnfield " + spawnfield::version() + " on "));
    CHECK_THAT(text, Contains("hash " + spawnfield::read_map(arena / "map").hash));
    CHECK(arena("experiment map --dims 2 --steps 1 -o out" + husky).status == 0);
    CHECK(table_of(arena / "out/experiment.md")[1].back().empty());  // one run has no variance
}

TEST_CASE("an experiment with searches has the counts of search for each seed")
{
    const Arena arena;
    const std::string stance = GENERATE("", " --yaw random", " --settle --max-slope 8", " --settle --yaw downhill");
    CAPTURE(stance);
    const std::string yaw = stance.find("--yaw") == std::string::npos ? " --yaw 0.3" : "";
    const std::string draws =
        "map -n 15 --min-distance 0.5 --max-failures 5000 --bounds -9,-9,-0.1,9,9,1 --keep-out -3,-3,3,3" + yaw +
        stance + husky;
    const nlohmann::json report = summary(arena, "experiment --search --seed 7 --runs 3 -o out " + draws);
    CHECK(report["command"] == "experiment");
    CHECK(report["seed"] == 7);
    CHECK(report["counts"]["valid"] == 45);
    const std::vector<Row> rows = rows_of(arena / "out/experiment.csv");
    REQUIRE(rows.size() == 3);
    std::set<std::string> different;
    for (std::size_t i = 0; i < 3; ++i) {
        CHECK(rows[i].at("seed") == std::to_string(7 + i));
        CHECK(rows[i].at("step").empty());
        check_counts(rows[i], summary(arena, "search -o /dev/null --seed " + rows[i].at("seed") + " " + draws));
        different.insert(rows[i].at("poses"));
    }
    CHECK(different.size() > 1);
    CHECK(table_of(arena / "out/experiment.md").size() == 2);
    CHECK_THAT(bytes_of(arena / "out/experiment.md"), Contains("- seed 7, one more for each further run\n"));
    const ProgramRun few = arena("experiment map --search -n 5 --min-distance 100 --max-failures 50 --runs 2 -o out" +
                                 husky);
    CHECK(few.status == 3);
    CHECK_THAT(few.err, Contains("notice: 2 runs of 2 found fewer than 5 spawns; a smaller --min-distance"));
    CHECK(rows_of(arena / "out/experiment.csv").size() == 2);
}

TEST_CASE("an experiment replaces an earlier experiment, but no other folder")
{
    const Arena arena;
    const std::string command = "experiment map --dims 2 --steps 2 -o out" + husky;
    CHECK(arena(command).status == 0);
    arena.write("out/experiment.md", "old");
    CHECK(arena(command).status == 0);
    CHECK(bytes_of(arena / "out/experiment.md") != "old");
    arena.write("out/notes.txt", "mine");
    arena.write("out/experiment.md", "old");
    const ProgramRun run = arena(command);
    CHECK(run.status == 1);
    CHECK(run.err ==
          "spawnfield: out: contains notes.txt, which is not part of any former experiment; choose another name or "
          "remove "
          "it\n");
    CHECK(bytes_of(arena / "out/experiment.md") == "old");
}
