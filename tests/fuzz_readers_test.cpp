#include "this_build.h"
#include "catch.h"
#include "fuzz/readers/reader.h"

#include <spawnfield/error.h>

#include <algorithm>

using namespace spawnfield;
namespace fs = std::filesystem;

namespace {

std::vector<fuzz::Reader> readers() { return fuzz::readers({source_folder(), program_file()}); }

/// Returns what was wrong with a reading; "" if it was right, although the file may have been refused.
std::string fault_of(const fuzz::Bench& bench, const std::string& input)
{
    try {
        bench.run(input);
    } catch (const std::exception& error) {
        return error.what();
    }
    return "";
}

}  // namespace

TEST_CASE("each seed of the fuzzer is read")
{
    const std::vector<fuzz::Reader> all = readers();
    const std::vector<fuzz::Seed> seeds = fuzz::seeds(all, source_folder());
    for (const fuzz::Reader& reader : all) {
        const fuzz::Bench bench(reader);
        CAPTURE(reader.name);
        CHECK(std::any_of(seeds.begin(), seeds.end(), [&](const auto& seed) { return seed.reader == reader.name; }));
        for (const fuzz::Seed& seed : seeds) {
            if (seed.reader != reader.name) continue;
            CAPTURE(seed.name, seed.input.substr(0, 200));
            CHECK(bench.run(seed.input) == "");
        }
    }
}

TEST_CASE("each file that the fuzzer has found gives a result or a FileError")
{
    std::size_t files = 0;
    for (const fuzz::Reader& reader : readers()) {
        const fs::path folder = fs::path(source_folder()) / "tests/data/fuzz" / reader.name;
        if (!fs::exists(folder)) continue;
        const fuzz::Bench bench(reader);
        for (const auto& entry : fs::directory_iterator(folder)) {
            CAPTURE(entry.path());
            CHECK(fault_of(bench, bytes_of(entry.path())) == "");
            ++files;
        }
    }
    const fs::recursive_directory_iterator all(fs::path(source_folder()) / "tests/data/fuzz");
    CHECK(files == std::size_t(std::count_if(begin(all), end(all), [](const auto& e) { return e.is_regular_file(); })));
}

TEST_CASE("a kept graph and a terrain.tiff that lie about sizes are refused before memory is allocated for them")
{
    const auto message = [](const std::string& name, const std::string& file) {
        const std::vector<fuzz::Reader> all = readers();
        const auto reader = std::find_if(all.begin(), all.end(), [&](const auto& known) { return known.name == name; });
        return fuzz::Bench(*reader).run(bytes_of(fs::path(source_folder()) / "tests/data/fuzz" / name / file));
    };
    CHECK_THAT(message("graphs", "too-many-places"), Contains("it has too many places for its ground"));
    CHECK_THAT(message("maps", "huge-tile"), Contains("input.tiff: is cut short in page height.0; bake the map again"));
}

TEST_CASE("the fuzzer notices other exceptions, messages without a file, and files that are left behind")
{
    const auto run = [](auto read) {
        const fuzz::Reader reader{"test", {".a", ".b"}, read};
        return fuzz::Bench(reader).run("bcontent");
    };
    CHECK(run([](const fs::path& file) {
              CHECK(file.extension() == ".b");
              CHECK(bytes_of(file) == "content");
          }) == "");
    CHECK_THAT(run([](const fs::path& file) { throw FileError(file.string(), "is bad"); }),
               Contains("input.b: is bad"));
    CHECK_THROWS_AS(run([](const fs::path&) { throw FileError("other", "is bad"); }), std::logic_error);
    CHECK_THROWS_AS(run([](const fs::path& file) { std::ofstream(file.string() + ".tmp") << "x"; }), std::logic_error);
    CHECK_THROWS_AS(run([](const fs::path&) { throw std::out_of_range("x"); }), std::out_of_range);
}
