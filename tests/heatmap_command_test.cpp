#include "arena.h"
#include "figure_text.h"

#include <algorithm>

namespace {

/// Runs `heatmap` for the Husky with a coarse step, which is fast.
ProgramRun heatmap(const Arena& arena, const std::string& arguments)
{
    return arena("heatmap map --step 0.5" + husky_option + arguments);
}

std::vector<std::string> texts_in(const Arena& arena, const std::string& file)
{
    return svg_texts(bytes_of(arena / file));
}

bool has(const std::vector<std::string>& texts, const std::string& part)
{
    return std::any_of(texts.begin(), texts.end(),
                       [&](const std::string& text) { return text.find(part) != std::string::npos; });
}

}  // namespace

TEST_CASE("file extensions that are not for pictures are refused before any work")
{
    const Arena arena;
    for (const std::string& command :
         {"heatmap map -o x.jpg" + husky_option, "raster map --dims 2 --step 1 --heatmap x.jpg -o x.csv" + husky_option,
          std::string("info 'box:1,1,1' --picture x.jpg"), "heatmap none -o x.jpg" + husky_option}) {
        CAPTURE(command);
        const ProgramRun run = arena(command);
        CHECK(run.status == 2);
        CHECK(run.err == "spawnfield: x.jpg ends in .jpg, but pictures are written as .png, .svg or .pdf; rename it\n");
    }
    const ProgramRun contradiction = heatmap(arena, "-o x.png --format svg");
    CHECK(contradiction.status == 2);
    CHECK(contradiction.err ==
          "spawnfield: --format is svg, but x.png ends in .png; make them agree, or leave --format out\n");
    CHECK(arena.names() == std::set<std::string>{"map"});
}

TEST_CASE("pictures of each command are PNG, SVG or PDF according to their extension")
{
    const Arena arena;
    const std::pair<std::string, std::string> starts[] = {{"png", "\x89PNG"}, {"svg", "<?xml"}, {"pdf", "%PDF-"}};
    for (const auto& [ending, start] : starts) {
        CAPTURE(ending);
        CHECK(heatmap(arena, "-o a." + ending).status == 0);
        CHECK(bytes_of(arena / ("a." + ending)).starts_with(start));
        CHECK(heatmap(arena, "-o plain --format " + ending).status == 0);
        CHECK(bytes_of(arena / "plain") == bytes_of(arena / ("a." + ending)));
        CHECK(heatmap(arena, "-q -o - --format " + ending).out == bytes_of(arena / "plain"));
        CHECK(arena("raster map --dims 2 --step 1 --heatmap r." + ending + husky_option).status == 0);
        CHECK(bytes_of(arena / ("r." + ending)).starts_with(start));
        CHECK(arena("info 'box:1,1,1' --picture i." + ending).status == 0);
        CHECK(bytes_of(arena / ("i." + ending)).starts_with(start));
    }
}

TEST_CASE("the picture names robot, offset, yaw and layers")
{
    const Arena arena;
    REQUIRE(heatmap(arena, "-o a.svg --stance level --offset 0.25 --yaw 0.5235987755982988 --layers top --max-slope 20")
                .status == 0);
    const std::vector<std::string> texts = texts_in(arena, "a.svg");
    CHECK(texts[0] == "training, husky");
    CHECK(texts[1] == "offset 0.25 m, yaw 30 deg, top layer, slope up to 20 deg");
    REQUIRE(arena("raster map --dims 3 --step 1 --heatmap r.svg" + husky_option).status == 0);
    CHECK(texts_in(arena, "r.svg")[1] == "yaw 0 deg, all layers (valid if one is)");
}

TEST_CASE("the ground is shown for the heading of the spawns")
{
    const Arena arena;
    arena.write("same.csv", "x,y,z,yaw\n0,3,0.1,1.5\n2,3,0.1,7.783185307179586\n");  // 1.5 rad, and one turn more
    arena.write("mixed.csv", "x,y,z,yaw\n0,3,0.1,0\n2,3,0.1,1\n50,3,0.1,1\n");
    const ProgramRun same = heatmap(arena, "-o same.svg --spawns same.csv");
    CHECK_THAT(
        same.err,
        Contains("notice: the ground is shown for yaw 1.5 rad, which all spawns have (--yaw RAD shows another)\n"));
    CHECK(has(texts_in(arena, "same.svg"), "yaw 85.94 deg"));

    const ProgramRun mixed = heatmap(arena, "-o mixed.svg --stance level --spawns mixed.csv");
    CHECK_THAT(mixed.err, Contains("notice: the spawns have different yaws: the ground shows at how many of 16 "
                                   "headings the robot fits (--yaw RAD shows one)\n"));
    CHECK(has(texts_in(arena, "mixed.svg"), "16 headings"));
    CHECK(has(texts_in(arena, "mixed.svg"), "valid at some headings"));
    CHECK(has(texts_in(arena, "mixed.svg"), "2 of 3 spawns in view"));

    const ProgramRun chosen = heatmap(arena, "-o chosen.svg --stance level --spawns mixed.csv --yaw 0");
    CHECK(chosen.err.find("notice") == std::string::npos);
    CHECK(has(texts_in(arena, "chosen.svg"), "yaw 0 deg"));
    const ProgramRun any = heatmap(arena, "-o any.svg --stance level --yaw random");
    CHECK(any.status == 0);
    CHECK_THAT(any.err, Contains("; 16 headings at each pose, each with its own exact checks; "));
    CHECK_THAT(chosen.err, !Contains("headings"));
    CHECK(has(texts_in(arena, "any.svg"), "valid at all 16 headings"));
    CHECK(heatmap(arena, "-o any.svg --yaw north").status == 2);
}

TEST_CASE("poses from check are drawn by verdict, with their names")
{
    const Arena arena;
    arena.write("poses.csv", "name,x,y,z\nstart,0,3,0.1\nwall,-6.5,-5,0.1\nlake,7,-7,0.1\n");
    REQUIRE(arena("check map --poses poses.csv -o checked.csv" + husky_option).status == 0);
    REQUIRE(heatmap(arena, "-o a.svg --spawns checked.csv --names").status == 0);
    std::vector<std::string> texts = texts_in(arena, "a.svg");
    for (const char* const text : {"3 spawns", "1 valid", "1 collision", "1 submerged", "start", "wall", "lake"})
        CHECK(has(texts, text));
    arena.write("plain.csv", "x,y,z\n0,3,0.1\n-1,3,0.1\n");
    REQUIRE(heatmap(arena, "-o a.svg --spawns plain.csv --names").status == 0);
    texts = texts_in(arena, "a.svg");
    CHECK(std::find(texts.begin(), texts.end(), "1") != texts.end());
    CHECK(std::find(texts.begin(), texts.end(), "2") != texts.end());
    const ProgramRun nothing_to_name = heatmap(arena, "-o b.svg --names");
    CHECK(nothing_to_name.status == 2);
    CHECK(nothing_to_name.err == "spawnfield: --names needs --spawns or --pairs, because it writes their names\n");
}

TEST_CASE("heatmap --fleet draws each spawn with the outline of its kind, from CSV and from JSON")
{
    const Arena arena;
    arena.write("fleet.yaml",
                "format: spawnfield-fleet/1\nrobots:\n- {name: truck, robot: 'box:1.2,0.8,0.3', count: 2}\n"
                "- {name: cart, robot: 'box:0.4,0.4,0.3', count: 3}\n");
    REQUIRE(arena("sample map --fleet fleet.yaml -o fleet.csv").status == 0);
    REQUIRE(arena("sample map --fleet fleet.yaml --format json -o fleet.json").status == 0);
    REQUIRE(heatmap(arena, "-o a.svg --spawns fleet.csv --fleet fleet.yaml --names").status == 0);
    const std::vector<std::string> texts = texts_in(arena, "a.svg");
    for (const char* const text : {"5 spawns", "2 truck", "3 cart", "truck_1", "cart_3"}) CHECK(has(texts, text));
    REQUIRE(heatmap(arena, "-o b.svg --spawns fleet.json --fleet fleet.yaml --names").status == 0);
    CHECK(bytes_of(arena / "a.svg") == bytes_of(arena / "b.svg"));

    const auto refuses = [&](const std::string& options, const std::string& message, int status) {
        CAPTURE(options);
        const ProgramRun run = heatmap(arena, "-o none.svg " + options);
        CHECK(run.status == status);
        CHECK_THAT(run.err, Contains(message));
        CHECK_FALSE(arena.names().contains("none.svg"));
    };
    refuses("--fleet fleet.yaml", "--fleet needs --spawns", 2);
    arena.write("plain.csv", "x,y,z\n0,3,0.1\n");
    refuses("--fleet fleet.yaml --spawns plain.csv", "plain.csv: column kind is missing, but --fleet needs it", 4);
    arena.write("other.csv", "x,y,z,kind\n0,3,0.1,truck\n0,3,0.1,boat\n");
    refuses("--fleet fleet.yaml --spawns other.csv",
            "other.csv: pose 2: column kind is \"boat\", needs a kind of fleet.yaml: truck, cart", 4);
    refuses("--fleet none.yaml --spawns fleet.csv", "none.yaml", 4);
}

TEST_CASE("with --floor or --z, only spawns, pairs and paths on that ground are drawn")
{
    const TempFolder folder;
    folder.write("scene.yaml",
                 "format: spawnfield-scene/1\nparts:\n"
                 "  - {name: floor, label: terrain, box: [12, 12, 0.1], xyz: [0, 0, -0.05]}\n"
                 "  - {name: deck, label: terrain, box: [6, 12, 0.1], xyz: [3, 0, 2.95]}\n");
    REQUIRE(run_program(folder, "bake scene.yaml -o map").status == 0);
    folder.write("spawns.csv", "name,x,y,z\nlow,-3,0,0.1\nunder,3,0,0.1\nhigh,3,2,3.1\n");
    folder.write("pairs.csv", "start_x,start_y,start_z,goal_x,goal_y,goal_z\n-3,0,0.1,3,0,0.1\n3,2,3.1,-3,2,0.1\n");
    folder.write("paths.csv", "pair,pose,x,y,z\n0,0,-3,0,0.1\n0,1,3,0,0.1\n1,0,3,2,3.1\n1,1,1,2,3.1\n1,2,-3,2,0.1\n");
    const auto texts = [&](const std::string& options) {
        const ProgramRun run = run_program(folder,
                                           "heatmap map --robot box:0.5,0.5,0.3 --step 0.5 -o a.svg " + options);
        CHECK(run.status == 0);
        std::vector<std::string> out = svg_texts(bytes_of(folder / "a.svg"));
        out.push_back(run.err);
        return out;
    };
    const std::vector<std::string> all = texts("--spawns spawns.csv --names");
    for (const char* const text : {"3 spawns", "low", "under", "high"}) CHECK(has(all, text));
    const std::vector<std::string> upper = texts("--spawns spawns.csv --names --floor 1");
    for (const char* const text :
         {"1 spawn", "high", "notice: 2 of 3 spawns stand on ground at other heights, and are not drawn"})
        CHECK(has(upper, text));
    CHECK_FALSE((has(upper, "low") || has(upper, "under")));
    const std::vector<std::string> lower = texts("--spawns spawns.csv --names --z :1");
    for (const char* const text : {"2 spawns", "low", "under", "1 of 3 spawns stands on ground at another height"})
        CHECK(has(lower, text));
    const std::vector<std::string> pairs = texts("--pairs pairs.csv --paths paths.csv --floor 0 --names");
    for (const char* const text : {"1 start", "2 goals", "1 path", "1 of 2 starts stands on ground at another height"})
        CHECK(has(pairs, text));
    const std::vector<std::string> high = texts("--pairs pairs.csv --paths paths.csv --floor 1");
    for (const char* const text : {"1 start", "1 path"}) CHECK(has(high, text));
    CHECK(has(high, "2 of 2 goals stand on ground at other heights"));
    CHECK_FALSE(has(high, "0 goals"));
}

TEST_CASE("heatmap draws the pairs and paths that sample writes")
{
    const Arena arena;
    REQUIRE(arena("sample map --pairs 6 --min-path 3 --reach-step 0.4 --path paths.csv -o pairs.csv" + husky_option)
                .status == 0);
    REQUIRE(heatmap(arena, "-o a.svg --pairs pairs.csv --paths paths.csv --names").status == 0);
    const std::vector<std::string> texts = texts_in(arena, "a.svg");
    for (const char* const text : {"6 starts", "6 goals", "6 paths"}) CHECK(has(texts, text));
    const ProgramRun no_pair = heatmap(arena, "-o b.svg --paths pairs.csv");
    CHECK(no_pair.status == 4);
    const ProgramRun plain = heatmap(arena, "-o b.svg --pairs paths.csv");
    CHECK(plain.status == 4);
    CHECK_THAT(plain.err, Contains("paths.csv: line 1: column start_x is missing"));
    arena.write("poses.csv", "x,y,z\n0,0,0\n");
    CHECK_THAT(heatmap(arena, "-o b.svg --paths poses.csv").err, Contains("poses.csv: column pair is missing"));
    CHECK_THAT(heatmap(arena, "-o b.svg --names").err, Contains("--names needs --spawns or --pairs"));
}

TEST_CASE("heat maps are the same bytes with any number of threads")
{
    const Arena arena;
    for (const char* const ending : {"png", "svg", "pdf"}) {
        const std::string file = std::string(".") + ending;
        REQUIRE(heatmap(arena, "--stance level --yaw random --threads 1 -o a" + file).status == 0);
        REQUIRE(heatmap(arena, "--stance level --yaw random --threads 3 -o b" + file).status == 0);
        CHECK(bytes_of(arena / ("a" + file)) == bytes_of(arena / ("b" + file)));
    }
}

TEST_CASE("heat maps of settled robots name the stance, the limit of the tilt and the quantity")
{
    const Arena arena;
    CHECK(heatmap(arena, "-o v.svg --max-slope 20").status == 0);
    CHECK(has(
        texts_in(arena, "v.svg"),
        "settled, yaw 0 deg, all layers (valid if one is), tilt up to 20 deg, margin from 0.00198 m, friction 0.8"));
    CHECK(heatmap(arena, "-o w.svg --friction 0.25 --min-stability 0.05").status == 0);
    CHECK(
        has(texts_in(arena, "w.svg"),
            "settled, yaw 0 deg, all layers (valid if one is), tilt up to 30 deg, margin from 0.05 m, friction 0.25"));
    for (const auto& [quantity, title] :
         {std::pair("tilt", "tilt, degrees"), std::pair("belly", "belly clearance, m")}) {
        CHECK(heatmap(arena, "-o q.svg --quantity " + std::string(quantity)).status == 0);
        CHECK(has(texts_in(arena, "q.svg"), title));
    }
}

TEST_CASE("a heat map of settled robots shows the obstacles beside a platform")
{
    const Arena arena;
    arena.write("scene.yaml",
                "format: spawnfield-scene/1\nname: post\nparts:\n"
                "  - {name: floor, label: terrain, box: [8, 8, 0.1], xyz: [0, 0, -0.05]}\n"
                "  - {name: platform, label: terrain, box: [3, 3, 0.8], xyz: [0, 0, 0.4]}\n"
                "  - {name: post, label: obstacle, box: [0.6, 0.6, 0.3], xyz: [2, 0, 0.15]}\n");
    CHECK(arena("bake scene.yaml -o post").status == 0);
    for (const std::string stance : {"level", "settled"}) {
        CAPTURE(stance);
        CHECK(arena("heatmap post --step 0.2 -o x.svg --stance " + stance + husky_option).status == 0);
        CHECK(has(texts_in(arena, "x.svg"), "obstacle"));
    }
}
