#include "arena.h"
#include "test_map.h"

#include <spawnfield/error.h>
#include <spawnfield/pose_stream.h>
#include <spawnfield/verdict_report.h>

#include <algorithm>
#include <cstdlib>
#include <random>

using namespace spawnfield;

namespace {

/// Returns a source that gives at most `most` bytes at once.
PoseStream::Source slow_source(std::string text, std::size_t most)
{
    return [=, at = std::size_t(0)](char* to, std::size_t size) mutable {
        const std::size_t count = text.copy(to, std::min(size, most), at);
        at += count;
        return count;
    };
}

/// Returns rows of poses in and around the training arena, with blank lines, quotes, and both ends of lines.
std::string mixed_rows(int count)
{
    std::mt19937 random(5);
    std::uniform_real_distribution<double> place(-11, 11), height(-0.5, 3), angle(-7, 7);
    std::string text = "\xEF\xBB\xBFname,x,y,z,yaw,hit\r\n";
    for (int i = 0; i < count; ++i) {
        text += i % 3 == 0 ? "\"a, \"\"b\"\"\"" : "plain";
        for (const double value : {place(random), place(random), height(random), angle(random)})
            text += ", " + std::to_string(value);
        text += i % 5 == 0 ? ",old\r\n\n" : ",old\n";
    }
    return text;
}

/// Returns the verdicts on the poses of a text that is read in parts of this many poses.
std::string verdicts_in_parts(const Judge& judge, bool is_settled, const std::string& text, std::size_t part,
                              int threads)
{
    PoseStream stream(slow_source(text, 1000), "poses");
    std::string out;
    VerdictCounts counts;
    do {
        const PoseTable table = stream.next(part, threads);
        const RunOptions run{.threads = threads};
        std::vector<SettledPose> settled;
        std::vector<Judgement> judgements;
        if (is_settled)
            for (const SettledPose& pose : settled = judge.settle(table.poses, run))
                judgements.push_back(judgement_of(pose));
        else
            judgements = judge.check(table.poses, run);
        VerdictReport report{table, judgements, judge, is_settled ? &settled : nullptr};
        report.first = counts.total();
        write_verdicts_csv(
            report, [&](std::string_view piece) { out += piece; }, threads);
        for (const Judgement& judged : judgements) ++counts[judged.verdict];
    } while (!stream.has_ended());
    return out;
}

std::string raster_text(const Judge& judge, const RasterOptions& options, bool aerial, std::int64_t part)
{
    std::string out;
    const RasterResult whole = raster(judge, options);
    const RasterResult head = raster_in_parts(
        judge, options,
        [&](const RasterResult& rows) { write_raster_csv(rows, aerial, [&](std::string_view text) { out += text; }); },
        part);
    CHECK(head.poses.empty());
    CHECK(head.exact_checks == whole.exact_checks);
    for (const Verdict verdict : all_verdicts) CHECK(head.counts[verdict] == whole.counts[verdict]);
    return out;
}

}  // namespace

TEST_CASE("a file that is read in parts has the poses, rows and notices of the whole file")
{
    std::string text = mixed_rows(2000);
    text.pop_back();  // the last line has no end
    const PoseTable whole = parse_poses(text, "poses");
    REQUIRE(whole.poses.size() == 2000);
    REQUIRE(whole.notices.size() == 1);  // yaw beyond a turn
    for (const std::size_t part : {1u, 7u, 1999u, 2000u, 2001u}) {
        PoseStream stream(slow_source(text, 100 + part), "poses");
        PoseTable joined;
        while (!stream.has_ended()) {
            const PoseTable table = stream.next(part, 2);
            CHECK(table.header == whole.header);
            CHECK((table.poses.size() == part || stream.has_ended()));
            joined.rows.insert(joined.rows.end(), table.rows.begin(), table.rows.end());
            joined.poses.insert(joined.poses.end(), table.poses.begin(), table.poses.end());
            joined.notices.insert(joined.notices.end(), table.notices.begin(), table.notices.end());
        }
        CHECK(joined.rows == whole.rows);
        CHECK(joined.notices == whole.notices);
        REQUIRE(joined.poses.size() == whole.poses.size());
        for (std::size_t i = 0; i < whole.poses.size(); ++i) {
            CHECK(joined.poses[i].position == whole.poses[i].position);
            CHECK(joined.poses[i].rotation == whole.poses[i].rotation);
        }
    }
}

TEST_CASE("of several wrong rows the first one is named, for any number of threads and any size of a part")
{
    std::string text = "x,y,z\n";
    for (int line = 2; line < 30000; ++line)
        text += line == 20000 || line == 9001 || line > 29990 ? "1,2,a\n" : "1,2,3\n";
    for (const int threads : {1, 2, 8})
        for (const std::size_t part : {std::size_t(100), PoseStream::all}) {
            PoseStream stream(slow_source(text, 4096), "f");
            CHECK_THROWS_WITH(
                [&] {
                    while (!stream.has_ended()) stream.next(part, threads);
                }(),
                "f: line 9001: column z is \"a\", needs a number");
        }
}

TEST_CASE("a line of more than a million characters is refused before it fills the memory")
{
    std::size_t bytes = 0;
    const auto endless = [&](char* to, std::size_t size) {
        std::fill(to, to + size, '1');
        bytes += size;
        return size;
    };
    CHECK_THROWS_WITH(PoseStream(endless, "f"), Contains("f: line 1: is longer than 1048576 characters"));
    CHECK(bytes < 10'000'000);
}

TEST_CASE("a stream without poses gives one empty part, or an error")
{
    CHECK_THROWS_WITH(PoseStream(slow_source("x,y,z\n", 9), "f"), Contains("f: has a header but no pose"));
    PoseStream stream(slow_source("x,y,z\n", 9), "f", true);
    const PoseTable table = stream.next();
    CHECK(table.poses.empty());
    CHECK(table.notices == std::vector<std::string>{"f: has a header but no pose"});
    CHECK(stream.has_ended());
    CHECK_THROWS_WITH(PoseStream(slow_source("", 9), "f"), Contains("f: is empty"));
}

TEST_CASE("verdicts that are written in parts are those of the whole table")
{
    const TestMap map = training_map();
    const Judge judge(map, husky());
    const std::string text = mixed_rows(500);
    for (const bool is_settled : {false, true}) {
        const PoseTable table = parse_poses(text, "poses");
        const std::string whole = is_settled ? settled_csv(table, judge.settle(table.poses, {}), judge)
                                             : verdicts_csv(table, judge.check(table.poses, {}), map);
        for (const std::size_t part : {1u, 63u, 500u})
            for (const int threads : {1, 8}) CHECK(verdicts_in_parts(judge, is_settled, text, part, threads) == whole);
    }
}

TEST_CASE("a raster in parts is the whole raster, in 2D and 3D, with aerial poses and for settled robots")
{
    const TestMap map = training_map();
    const Judge judge(map, husky());
    const auto agrees = [&](const RasterOptions& options, bool aerial) {
        const std::string whole = csv_of(raster(judge, options), aerial);
        for (const std::int64_t part : {1, 200, 1 << 20}) CHECK(raster_text(judge, options, aerial, part) == whole);
    };
    agrees({.step = 0.5}, false);
    agrees({.dims = 3, .step = 1, .step_z = 0.3}, true);
    agrees({.dims = 3, .step = 1, .step_z = 0.3, .snap = true}, true);
    agrees({.step = 1, .stance = Stance::Settled}, false);
    RasterOptions outside{.step = 1};
    outside.area.within = {box_region(-5, -5, 5, 5)};
    agrees(outside, false);
}

TEST_CASE("check writes all verdicts or none, also of many poses to standard output")
{
    const Arena arena;
    std::string text = "x,y,z,yaw\n";
    for (int i = 0; i < 150'000; ++i)
        text += std::to_string(i % 20 - 10) + "," + std::to_string(i % 13 - 6) + ",0.5,0\n";
    arena.write("many.csv", text);
    arena.write("broken.csv", text + "1,2\n");
    const std::string command = "check map" + husky_option;
    const ProgramRun whole = arena(command + "--poses many.csv -o out.csv");
    REQUIRE(whole.status == 0);
    CHECK_THAT(whole.err, Contains("150000 poses"));
    const std::string verdicts = bytes_of(arena / "out.csv");
    CHECK(std::count(verdicts.begin(), verdicts.end(), '\n') == 150'001);
    CHECK(arena(command + "--poses many.csv --threads 1").out == verdicts);
    CHECK(arena(command + "--poses - < many.csv").out == verdicts);
    CHECK(arena("check map --poses many.csv -q --require-valid" + husky_option)
              .err.starts_with("spawnfield: --require-valid: "));

    const ProgramRun broken = arena(command + "--poses broken.csv");
    CHECK(broken.status == 4);
    CHECK(broken.out.empty());
    CHECK_THAT(broken.err, Contains("broken.csv: line 150002: has 2 fields, the header has 4"));
    CHECK(arena(command + "--poses broken.csv -o out.csv").status == 4);
    CHECK(bytes_of(arena / "out.csv") == verdicts);
}

TEST_CASE("a text for standard output that needs a temporary file comes whole, and an error names that file's folder")
{
    const Arena arena;
    const std::string command = "raster map --dims 2 --step 0.025 -q" + husky_option;
    CHECK(arena(command + "-o out.csv").status == 0);
    const std::string whole = bytes_of(arena / "out.csv");
    REQUIRE(whole.size() > (16u << 20));  // longer than what is kept in memory
    CHECK(arena(command).out == whole);
    const char* const before = std::getenv("TMPDIR");
    const std::string old = before == nullptr ? "/tmp" : before;
    setenv("TMPDIR", (arena / "none").c_str(), 1);
    const ProgramRun none = arena(command);
    setenv("TMPDIR", old.c_str(), 1);
    CHECK(none.status == 1);
    CHECK(none.out.empty());
    CHECK_THAT(none.err, Contains("a temporary file in " + (arena / "none").string() + " cannot be made"));
}
