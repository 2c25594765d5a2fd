#include "base/deflate.h"
#include "picture/palette.h"
#include "drawing/relief.h"

#include <spawnfield/error.h>
#include <spawnfield/heatmap.h>

#include "catch.h"
#include "figure_text.h"
#include "temp_folder.h"
#include "test_map.h"

#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>

#include <algorithm>
#include <cmath>
#include <sstream>

using namespace spawnfield;

namespace {

using Drawing = std::vector<std::string>;
using Surface = std::function<float(double x, double y)>;

constexpr float nothing = std::numeric_limits<float>::quiet_NaN();
constexpr double pi = 3.14159265358979323846;

// ---------------------------------------------------------------- inputs

std::string tile_of(const GridFrame& frame, const Surface& surface, int first_row, int first_col)
{
    constexpr int side = TerrainMap::tile;
    std::vector<float> cells(side * side, nothing);
    for (int row = 0; row < side && first_row + row < frame.rows; ++row)
        for (int col = 0; col < side && first_col + col < frame.cols; ++col)
            cells[std::size_t(row * side + col)] = surface(frame.x_of(first_col + col), frame.y_of(first_row + row));
    return deflate_floats(cells, side);
}

void add_page(TerrainMap& terrain, const std::string& name, const Surface& surface)
{
    TerrainMap::Page page{name, {}};
    for (int row = 0; row < terrain.tile_rows(); ++row)
        for (int col = 0; col < terrain.tile_cols(); ++col)
            page.tiles.push_back(tile_of(terrain.frame, surface, row * TerrainMap::tile, col * TerrainMap::tile));
    terrain.pages.push_back(page);
}

/// Returns terrain with x from 0 to `width` and y from 0 to `height`.
TerrainMap terrain_of(double width, double height, const Surface& surface, double cell = 0.25)
{
    TerrainMap terrain;
    terrain.frame.cell = cell;
    terrain.frame.cols = int(std::ceil(width / cell));
    terrain.frame.rows = int(std::ceil(height / cell));
    add_page(terrain, "height.0", surface);
    return terrain;
}

TerrainMap level_terrain(double width, double height)
{
    return terrain_of(width, height, [](double, double) { return 0.0f; });
}

Verdict verdict_of(char letter)
{
    switch (letter) {
    case 'X': return Verdict::Outside;
    case 'A': return Verdict::Aerial;
    case 'O': return Verdict::OffTerrain;
    case 'S': return Verdict::Submerged;
    case 'C': return Verdict::Collision;
    case 'T': return Verdict::Steep;
    case 'U': return Verdict::Unstable;
    default: return Verdict::Valid;
    }
}

void add_pose(RasterResult& raster, int i, int j, double z, Verdict verdict)
{
    raster.poses.push_back({raster.grid.x_of(i), raster.grid.y_of(j), z, 0, verdict});
    ++raster.counts[verdict];
}

/// Returns a raster with a column for each letter; the first line has the largest y, and '.' has no pose. Columns are 2
/// m apart, starting at (1, 1).
RasterResult raster_of(const Drawing& drawing)
{
    RasterResult raster;
    raster.grid.x0 = raster.grid.y0 = 1;
    raster.grid.step = 2;
    raster.grid.cols = int(drawing[0].size());
    raster.grid.rows = int(drawing.size());
    for (int j = 0; j < raster.grid.rows; ++j)
        for (int i = 0; i < raster.grid.cols; ++i)
            if (const char letter = drawing[drawing.size() - 1 - std::size_t(j)][std::size_t(i)]; letter != '.')
                add_pose(raster, i, j, 0.1, verdict_of(letter));
    return raster;
}

// ---------------------------------------------------------------- pictures

/// A picture. Its plot is the area inside the frame, which has a colour of its own.
struct Picture {
    Image image;
    cv::Rect plot;
    View view;  ///< area of the map that the plot shows

    cv::Point pixel(double x, double y) const
    {
        return {plot.x + int((x - view.x0) / view.width * plot.width),
                plot.y + int((view.y0 + view.height - y) / view.height * plot.height)};
    }
    Colour at(double x, double y) const { return image(pixel(x, y)); }
};

const Colour frame_colour = rgb(0x404040);

/// Returns the longest run of the frame colour in a row: its first column, and the one after its last.
cv::Range longest_run(const Image& image, int row)
{
    cv::Range longest(0, 0);
    for (int col = 0, first = 0; col < image.cols; ++col) {
        if (image(row, col) != frame_colour)
            first = col + 1;
        else if (col + 1 - first > longest.size())
            longest = {first, col + 1};
    }
    return longest;
}

/// Returns the plot. A tick at the edge of the plot makes one line of the frame longer than the others.
cv::Rect find_plot(const Image& image)
{
    int width = 0;
    for (int row = 0; row < image.rows; ++row) width = std::max(width, longest_run(image, row).size());
    std::vector<int> rows;  // of the upper and lower line of the frame
    cv::Range across(0, image.cols);
    for (int row = 0; row < image.rows; ++row)
        if (const cv::Range run = longest_run(image, row); run.size() > 0.85 * width) {
            rows.push_back(row);
            across = across & run;
        }
    REQUIRE(!rows.empty());
    const int thickness = int(rows.size()) / 2;
    return {across.start + thickness, rows.front() + thickness, across.size() - 2 * thickness,
            rows.back() - rows.front() + 1 - 2 * thickness};
}

Picture read_picture(const std::filesystem::path& file, const View& view)
{
    Picture picture;
    picture.image = cv::imread(file.string(), cv::IMREAD_COLOR);
    REQUIRE(!picture.image.empty());
    picture.plot = find_plot(picture.image);
    picture.view = view;
    return picture;
}

Picture draw(const RasterResult& raster, const HeatmapOptions& options = {},
             const TerrainMap& terrain = level_terrain(20, 20), const Map& map = {})
{
    const TempFolder folder;
    write_heatmap(map, terrain, raster, options, folder / "picture.png");
    const RasterGrid& grid = raster.grid;
    return read_picture(folder / "picture.png", with_room({grid.x0 - grid.step / 2, grid.y0 - grid.step / 2,
                                                           grid.cols * grid.step, grid.rows * grid.step}));
}

/// Returns the texts of the picture, from its SVG.
std::vector<std::string> texts_of(const RasterResult& raster, const HeatmapOptions& options = {},
                                  const TerrainMap& terrain = level_terrain(20, 20), const Map& map = {})
{
    const TempFolder folder;
    write_heatmap(map, terrain, raster, options, folder / "picture.svg");
    return svg_texts(bytes_of(folder / "picture.svg"));
}

bool contains(const std::vector<std::string>& texts, const std::string& text)
{
    return std::find(texts.begin(), texts.end(), text) != texts.end();
}

int count_outside_plot(const Picture& picture, Colour colour)
{
    int count = 0;
    for (int row = 0; row < picture.image.rows; ++row)
        for (int col = 0; col < picture.image.cols; ++col)
            count += picture.image(row, col) == colour && !picture.plot.contains({col, row});
    return count;
}

int brightness(Colour colour) { return colour[0] + colour[1] + colour[2]; }

Colour of(Verdict verdict) { return rgb(verdict_palette[std::size_t(verdict)]); }

const Colour valid = of(Verdict::Valid), collision = of(Verdict::Collision), submerged = of(Verdict::Submerged),
             off_terrain = of(Verdict::OffTerrain), steep = of(Verdict::Steep), unstable = of(Verdict::Unstable),
             aerial = of(Verdict::Aerial), outside = of(Verdict::Outside), no_pose = rgb(no_pose_colour),
             some_headings = rgb(some_headings_colour), obstacle = rgb(obstacle_colour);

Colour colour_of(char letter)
{
    switch (letter) {
    case 'X': return outside;
    case 'A': return aerial;
    case 'O': return off_terrain;
    case 'T': return steep;
    case 'U': return unstable;
    case 'S': return submerged;
    case 'C': return collision;
    case '.': return no_pose;
    default: return valid;
    }
}

}  // namespace

TEST_CASE("each column has the colour of its verdict, at its place and up to its edges")
{
    const Drawing drawing = GENERATE(Drawing{"VCSOA", "X.VVC", "SSVOO"}, Drawing{"VTUCS"}, Drawing{"CVVVVVVVVVVS"},
                                     Drawing{"C", "V", "V", "S", "."}, Drawing{"O"});
    const int pixels = GENERATE(300, 1000, 1501);
    const RasterResult raster = raster_of(drawing);
    const Picture picture = draw(raster, {.pixels = pixels});
    for (int j = 0; j < raster.grid.rows; ++j)
        for (int i = 0; i < raster.grid.cols; ++i)
            for (const double dx : {-0.8, 0.0, 0.8})
                for (const double dy : {-0.8, 0.0, 0.8}) {
                    CAPTURE(pixels, i, j, dx, dy);
                    const char letter = drawing[drawing.size() - 1 - std::size_t(j)][std::size_t(i)];
                    CHECK(picture.at(raster.grid.x_of(i) + dx, raster.grid.y_of(j) + dy) == colour_of(letter));
                }
}

TEST_CASE("the longer side of a picture has the requested length, and nothing is cut off")
{
    const auto [cols, rows] = GENERATE(table<int, int>({{1, 1}, {6, 1}, {1, 6}, {40, 1}, {1, 40}, {7, 4}}));
    const int pixels = GENERATE(200, 1000, 2000);
    const auto quantity = GENERATE(HeatmapQuantity::Verdict, HeatmapQuantity::Height);
    RasterResult raster = raster_of(Drawing(std::size_t(rows), std::string(std::size_t(cols), 'V')));
    raster.counts[Verdict::Outside] = 1234567;
    const std::string title = "a title that is so long that a narrow picture has to make room for it";
    const Picture picture = draw(raster, {.quantity = quantity, .pixels = pixels, .title = title});

    CAPTURE(cols, rows, pixels);
    const Image& image = picture.image;
    CHECK(std::max(image.cols, image.rows) == pixels);
    int coloured = 0;
    for (int row = 0; row < image.rows; ++row)
        coloured += image(row, 0) != white || image(row, image.cols - 1) != white;
    for (int col = 0; col < image.cols; ++col)
        coloured += image(0, col) != white || image(image.rows - 1, col) != white;
    CHECK(coloured == 0);
    CHECK(double(picture.plot.width) / picture.plot.height ==
          Approx(picture.view.width / picture.view.height).epsilon(0.1));  // pixels are whole numbers
}

TEST_CASE("the legend shows every verdict that a two-dimensional raster may have")
{
    const Picture picture = draw(raster_of({"V"}));
    for (const Colour& colour : {valid, collision, submerged, off_terrain})
        CHECK(count_outside_plot(picture, colour) > 300);
    for (const Colour& colour : {aerial, outside, steep, unstable, no_pose})
        CHECK(count_outside_plot(picture, colour) < 100);  // edges of texts are grey
}

TEST_CASE("the legend shows rare verdicts and columns without terrain only if there are any")
{
    const Picture picture = draw(raster_of({"VXATU."}));
    for (const Colour& colour : {aerial, outside, steep, unstable, no_pose})
        CHECK(count_outside_plot(picture, colour) > 300);
}

TEST_CASE("a column is valid if any of its poses is, or else it has the verdict of its highest pose")
{
    RasterResult raster = raster_of({"..."});
    for (const int i : {0, 1}) add_pose(raster, i, 0, 3, Verdict::Collision);
    add_pose(raster, 0, 0, 2, Verdict::Valid);
    add_pose(raster, 0, 0, 1, Verdict::Submerged);
    add_pose(raster, 1, 0, 1, Verdict::Submerged);
    const Picture picture = draw(raster);
    CHECK(picture.at(1, 1) == valid);
    CHECK(picture.at(3, 1) == collision);
    CHECK(picture.at(5, 1) == no_pose);
}

TEST_CASE("a column of a three-dimensional raster without a listed pose is aerial")
{
    RasterResult raster = raster_of({"V."});
    raster.dims = 3;
    raster.counts[Verdict::Aerial] = 12;
    const Picture picture = draw(raster);
    CHECK(picture.at(1, 1) == valid);
    CHECK(picture.at(3, 1) == aerial);
}

TEST_CASE("ground that faces north-west is lighter than ground that faces south-east, in the same hue")
{
    const auto roof = [](double x, double y) {
        return float(-0.5 * std::abs((x - 5) - (y - 5)));
    };  // a ridge from south-west to north-east
    const Picture picture = draw(raster_of({"VVVVV", "VVVVV", "VVVVV", "VVVVV", "VVVVV"}), {},
                                 terrain_of(10, 10, roof));
    const Colour lit = picture.at(2, 8), dark = picture.at(8, 2);
    CHECK(brightness(lit) > brightness(valid));
    CHECK(brightness(dark) < brightness(valid));
    for (const Colour& colour : {lit, dark}) {
        CHECK(colour[1] > colour[2]);  // more green than red, and more red than blue
        CHECK(colour[2] > colour[0]);
    }
}

TEST_CASE("an arrow is at the place of its spawn and points along its yaw")
{
    const double yaw = GENERATE(0, 1, 2, 3) * pi / 2;
    const RasterResult raster = raster_of({"VVVVV", "VVVVV", "VVVVV"});
    const HeatmapOptions options{.spawns = {{{3.3, 4.4, 0.1}, yaw}}};
    const Picture picture = draw(raster, options);
    CHECK(picture.at(3.3, 4.4) == white);
    CHECK(picture.at(6.7, 1.6) == valid);

    const double pixel = picture.view.width / picture.plot.width;
    int ahead = 0, behind = 0;  // pixels of the arrow along its axis
    for (int steps = 1; steps < 30; ++steps) {
        const double dx = steps * pixel * std::cos(yaw), dy = steps * pixel * std::sin(yaw);
        ahead += picture.at(3.3 + dx, 4.4 + dy) != valid;
        behind += picture.at(3.3 - dx, 4.4 - dy) != valid;
    }
    CHECK(ahead > 2 * behind);  // the tail is notched
    CHECK(behind > 0);
}

TEST_CASE("a measured quantity has the colours of its values where the pose is valid")
{
    const RasterResult raster = raster_of({"VCV", "VVV"});  // row 0 of the drawing has the largest y
    HeatmapOptions options{.quantity = HeatmapQuantity::Clearance};
    for (const RasterPose& pose : raster.poses) options.values.push_back(pose.x);
    const double largest = *std::max_element(options.values.begin(), options.values.end());
    const Picture picture = draw(raster, options);
    for (std::size_t p = 0; p < raster.poses.size(); ++p) {
        const RasterPose& pose = raster.poses[p];
        const bool is_valid = pose.verdict == Verdict::Valid;
        CHECK(picture.at(pose.x, pose.y) ==
              (is_valid ? viridis()[std::size_t(std::lround(pose.x / largest * 255))] : rgb(0x9a9a9a)));
    }
    options.values.pop_back();
    CHECK_THROWS_WITH(draw(raster, options),
                      Contains("size of values is 5, needs as many as the raster's poses for this quantity"));
}

TEST_CASE("height shows the pose that represents the column")
{
    RasterResult raster = raster_of({"..."});
    add_pose(raster, 0, 0, 0, Verdict::Valid);
    add_pose(raster, 1, 0, 5, Verdict::Collision);
    add_pose(raster, 1, 0, 1, Verdict::Valid);
    const Picture picture = draw(raster, {.quantity = HeatmapQuantity::Height});
    CHECK(picture.at(1, 1) == viridis().front());
    CHECK(picture.at(3, 1) == viridis().back());
    CHECK(picture.at(5, 1) == no_pose);
    int in_bar = 0;
    for (const Colour& colour : viridis()) in_bar += count_outside_plot(picture, colour) > 0;
    CHECK(in_bar > 80);
}

TEST_CASE("how the robot stands is shown on valid columns; rolls and pitches may be negative")
{
    RasterResult raster = raster_of({"VVC"});
    const auto rest = [](double roll, double tilt, double margin) {
        RasterRest out;
        out.roll = roll * pi / 180;
        out.tilt = tilt * pi / 180;
        out.margin = margin;
        return out;
    };
    raster.rests = {rest(-10, 10, 0.1), rest(20, 20, 0.4), rest(40, 40, 0.9)};
    const Picture roll = draw(raster, {.quantity = HeatmapQuantity::Roll});
    CHECK(roll.at(1, 1) == viridis().front());
    CHECK(roll.at(3, 1) == viridis().back());
    CHECK(roll.at(5, 1) == rgb(0x9a9a9a));
    const Picture tilt = draw(raster, {.quantity = HeatmapQuantity::Tilt});
    CHECK(tilt.at(1, 1) == viridis()[128]);  // the scale is 0 .. 20 degrees
    CHECK(tilt.at(3, 1) == viridis().back());
    const Picture margin = draw(raster, {.quantity = HeatmapQuantity::Margin});
    CHECK(margin.at(1, 1) == viridis()[64]);  // the scale is 0 .. 0.4 m
    CHECK(contains(texts_of(raster, {.quantity = HeatmapQuantity::Margin}), "stability margin, m"));
    raster.rests.clear();
    CHECK_THROWS_WITH(draw(raster, {.quantity = HeatmapQuantity::Belly}),
                      Contains("size of raster.rests is 0") && Contains("a raster of settled poses at one yaw"));
}

TEST_CASE("slope is that of the layer below the pose, and the scale ends at the largest")
{
    const auto ground = [](double, double y) { return y < 6 ? 0.0f : float(y - 6); };
    const Picture picture = draw(raster_of({"V", "V", "V", "V", "V", "V"}), {.quantity = HeatmapQuantity::Slope},
                                 terrain_of(2, 12, ground));
    CHECK(picture.at(1, 1) == viridis().front());
    const Colour steepest = viridis().back(), seen = picture.at(1, 11);  // it is shaded, so the colour is only similar
    for (int c = 0; c < 3; ++c) CHECK(std::abs(seen[c] - steepest[c]) < 60);
}

TEST_CASE("under a level roof slope is that of the ramp below, where the shown pose stands")
{
    // A roof at 10 m over x < 6; below it, and as the top layer beyond it, a ramp of 1 in 5: 11.3 degrees.
    const auto ramp = [](double x, double) { return float(0.2 * x); };
    TerrainMap terrain = terrain_of(12, 2, [=](double x, double y) { return x < 6 ? 10.0f : ramp(x, y); });
    add_page(terrain, "height.1", [=](double x, double y) { return x < 6 ? ramp(x, y) : nothing; });
    RasterResult raster = raster_of({"......"});
    raster.offset = 0.1;
    for (int i = 0; i < 6; ++i) add_pose(raster, i, 0, 0.2 * raster.grid.x_of(i) + 0.1, Verdict::Valid);
    const std::vector<std::string> texts = texts_of(raster, {.quantity = HeatmapQuantity::Slope}, terrain);
    CAPTURE(texts);
    CHECK(contains(texts, "11.3"));  // the end of the scale; the edge of the roof is not a cliff
    raster.poses[0].z = 10.1;        // now on the roof, which is level
    const Picture picture = draw(raster, {.quantity = HeatmapQuantity::Slope}, terrain);
    CHECK(picture.at(1, 1) == viridis().front());
    CHECK(brightness(picture.at(3, 1)) > brightness(viridis()[200]));
}

TEST_CASE("a gradient is one-sided beside a hole, and there is none in the hole")
{
    HeightImage heights(3, 3);
    heights.values = {4, 5, 6,        //
                      2, 3, nothing,  //
                      0, 1, 2};
    CHECK(gradient(heights, 1, 1, 0.5).isApprox(Eigen::Vector2d(2, 4)));
    CHECK(gradient(heights, 0, 0, 0.5).isApprox(Eigen::Vector2d(2, 4)));
    CHECK(gradient(heights, 1, 2, 0.5).hasNaN());
}

TEST_CASE("options and rasters out of range are refused with their limits")
{
    const TempFolder folder;
    const TerrainMap terrain = level_terrain(2, 2);
    RasterResult raster = raster_of({"V"});
    const auto write = [&](const HeatmapOptions& options) {
        write_heatmap({}, terrain, raster, options, folder / "a.png");
    };
    CHECK_THROWS_WITH(write({.pixels = 199}), "write_heatmap: pixels is 199, needs 200 .. 16000");
    CHECK_THROWS_AS(write({.pixels = 16001}), ArgumentError);
    raster.poses[0].x = 40;
    CHECK_THROWS_WITH(write({}), Contains("x of a pose is 40"));
    raster.grid.cols = 0;
    CHECK_THROWS_WITH(write({}), Contains("raster.grid.cols is 0, needs >= 1"));
    raster.grid.step = 0;
    CHECK_THROWS_WITH(write({}), Contains("raster.grid.step is 0, needs > 0 m"));
    CHECK_THROWS_AS(write_preview({}, {}, folder / "a.png"), ArgumentError);
    CHECK_FALSE(std::filesystem::exists(folder / "a.png"));
}

TEST_CASE("pictures are the same bytes each time")
{
    const TempFolder folder;
    const TerrainMap terrain = terrain_of(6, 4, [](double x, double y) { return float(std::sin(x) * y); });
    const RasterResult raster = raster_of({"VCS", "OV."});
    for (const char* name : {"a.png", "b.png"})
        write_heatmap({}, terrain, raster, {.spawns = {{{1, 1, 0}, 0.3}}, .title = "twice"}, folder / name);
    CHECK(!bytes_of(folder / "a.png").empty());
    CHECK((bytes_of(folder / "a.png") == bytes_of(folder / "b.png")));
}

TEST_CASE("a picture that cannot be written is an OutputError")
{
    const TempFolder folder;
    CHECK_THROWS_AS(write_heatmap({}, level_terrain(2, 2), raster_of({"V"}), {}, folder / "missing/a.png"),
                    OutputError);
}

TEST_CASE("a preview shows terrain by height, obstacles grey, water blue, and white where there is nothing")
{
    // From left to right: low ground, high ground, a block on the ground, a lake, nothing, a block in the air, a pier.
    const auto ground = [](double x, double) { return x < 4 ? 0.0f : x < 12 ? 2.0f : x < 16 ? -1.0f : nothing; };
    const auto obstacle = [](double x, double) {
        return x > 8 && x < 12 ? 5.0f : x > 20 && x < 24 ? 4.0f : x > 24 ? 3.0f : nothing;
    };
    TerrainMap terrain = terrain_of(28, 8, ground);
    add_page(terrain, "obstacle", obstacle);
    add_page(terrain, "water", [](double x, double) { return (x > 12 && x < 16) || x > 24 ? 1.0f : nothing; });
    const TempFolder folder;
    Map map;
    map.name = "preview";
    write_preview(map, terrain, folder / "preview.png");
    const Picture picture = read_picture(folder / "preview.png", {0, 0, 28, 8});

    CHECK(std::max(picture.image.cols, picture.image.rows) == 1000);
    const Colour low = picture.at(2, 4), high = picture.at(6, 4), lake = picture.at(14, 4);
    CHECK(brightness(low) < brightness(high));
    CHECK(low[1] > low[0]);
    CHECK(high[2] > high[0]);
    CHECK(lake[0] > lake[2] + 50);
    for (const double x : {10.0, 22.0, 26.0}) {
        const Colour block = picture.at(x, 4);
        CHECK(block[0] == block[1]);
        CHECK(block[1] == block[2]);
        CHECK(block != white);
    }
    CHECK(picture.at(18, 4) == white);
    CHECK(count_outside_plot(picture, lake) > 100);  // the legend
}

// ---------------------------------------------------------------- legends

TEST_CASE("the legend counts columns by their colours, not poses")
{
    RasterResult raster = raster_of({"VVC."});
    add_pose(raster, 2, 0, 5, Verdict::Valid);  // another layer, so the column is valid
    const std::vector<std::string> texts = texts_of(raster);
    CHECK(contains(texts, "3 columns, 2 m apart"));
    CHECK(contains(texts, "3   100.0 %"));  // valid
    CHECK(contains(texts, "0"));            // collision
    CHECK(contains(texts, "1 column"));     // no terrain; not part of the shares
}

TEST_CASE("a caption is below the title")
{
    const std::vector<std::string> texts = texts_of(raster_of({"V"}),
                                                    {.title = "arena, husky", .caption = "offset 0.1 m, yaw 0 deg"});
    CHECK(texts[0] == "arena, husky");
    CHECK(texts[1] == "offset 0.1 m, yaw 0 deg");
}

TEST_CASE("scales of height end at the lowest and highest values")
{
    RasterResult raster = raster_of({".."});
    add_pose(raster, 0, 0, 0.13, Verdict::Valid);
    add_pose(raster, 1, 0, 7.24, Verdict::Valid);
    const std::vector<std::string> texts = texts_of(raster, {.quantity = HeatmapQuantity::Height});
    CAPTURE(texts);
    CHECK(contains(texts, "0.1"));
    CHECK(contains(texts, "7.2"));
    CHECK_FALSE(contains(texts, "8"));
}

// ---------------------------------------------------------------- headings

TEST_CASE("with several headings a column is valid at all of them, at some or at none")
{
    RasterResult raster = raster_of({"VVVC"});
    HeatmapOptions options{.headings = 16, .valid_headings = {16, 15, 1, 0}};
    const Picture picture = draw(raster, options);
    CHECK(picture.at(1, 1) == valid);
    CHECK(picture.at(3, 1) == some_headings);
    CHECK(picture.at(5, 1) == some_headings);
    CHECK(picture.at(7, 1) == collision);
    const std::vector<std::string> texts = texts_of(raster, options);
    CHECK(contains(texts, "valid at all 16 headings"));
    CHECK(contains(texts, "2   50.0 %"));

    add_pose(raster, 1, 0, -3, Verdict::Valid);  // a lower layer that is valid at more headings is shown
    options.valid_headings = {16, 15, 1, 0, 16};
    CHECK(draw(raster, options).at(3, 1) == valid);
    options.valid_headings.pop_back();
    CHECK_THROWS_WITH(draw(raster, options),
                      Contains("size of valid_headings is 4, needs as many as the raster's poses, or none"));
}

TEST_CASE("quantities count a pose as valid if it is valid at all headings")
{
    const RasterResult raster = raster_of({"VVV", "VVV", "VVV"});
    const HeatmapOptions options{
        .quantity = HeatmapQuantity::Height, .headings = 4, .valid_headings = {4, 4, 4, 4, 3, 4, 4, 4, 4}};
    const Picture picture = draw(raster, options);
    CHECK(picture.at(3, 3) == rgb(0x9a9a9a));
    CHECK(picture.at(1, 3) != rgb(0x9a9a9a));
}

// ---------------------------------------------------------------- obstacles

TEST_CASE("obstacles at the height of the robot are dark, and other collisions have the collision colour")
{
    // A wall, a beam 3 m above the ground, and a block that begins above a low robot: on a floor of 12 x 12 m.
    const TempFolder folder;
    const TestMap map = map_of(load_scene(folder.write("scene.yaml", R"(
format: spawnfield-scene/1
parts:
  - {name: floor, label: terrain, box: [12, 12, 1], xyz: [6, 6, -0.5]}
  - {name: wall, box: [0.3, 12, 2], xyz: [6, 6, 1]}
  - {name: beam, box: [12, 0.5, 0.2], xyz: [6, 11, 3]}
  - {name: block, box: [1, 1, 1], xyz: [10, 4, 1]}
)")));
    const Robot low = load_robot("box:2,1,0.3"), high = load_robot("box:2,1,0.6");
    const auto verdicts = [&](const Robot& robot) {
        RasterOptions options{.step = 0.25};
        return raster(Judge(map, robot), options);
    };
    const TerrainMap terrain = rasterize_terrain(map.geometry, frame_around(map.bounds, 0.1));
    const RasterResult result = verdicts(low);
    const Picture picture = draw(result, {.robot = &low}, terrain, map);
    CHECK(picture.at(6, 5) == obstacle);
    CHECK(picture.at(5.9, 5) == obstacle);  // not only at the columns of the raster
    CHECK(picture.at(5.2, 5) == collision);
    CHECK(picture.at(6.8, 5) == collision);
    CHECK(picture.at(4.5, 5) == valid);
    CHECK(picture.at(2, 11) == valid);  // below the beam
    CHECK(picture.at(10, 4) == valid);  // below the block
    CHECK(draw(verdicts(high), {.robot = &high}, terrain, map).at(10, 4) == obstacle);

    // There are 49 columns in y. The columns of the wall are at x = 6, and its margin reaches 1 m + 0.15 m to each
    // side.
    const std::vector<std::string> texts = texts_of(result, {.robot = &low}, terrain, map);
    CHECK(contains(texts, "49   2.0 %"));
    const auto row = std::count_if(result.poses.begin(), result.poses.end(), [](const RasterPose& pose) {
        return pose.y == 2 && pose.verdict == Verdict::Collision;
    });
    CHECK(contains(texts,
                   with_commas(std::uint64_t(49 * (row - 1))) + "   " + fixed(100.0 * double(row - 1) / 49, 1) + " %"));
}

TEST_CASE("obstacles on a slope are found at the height of the ground below them")
{
    // The slope has 45 degrees and columns are 2 m apart, so between columns the ground differs by up to 1 m.
    const TempFolder folder;
    folder.write("slope.obj", "o slope\nv 0 0 0\nv 12 0 12\nv 12 4 12\nv 0 4 0\nf 1 2 3 4\n");
    const TestMap map = map_of(load_scene(folder.write("scene.yaml", R"(
format: spawnfield-scene/1
parts:
  - {name: slope, label: terrain, mesh: slope.obj}
  - {name: pole, cylinder: {radius: 0.2, length: 0.4}, xyz: [6.9, 2, 7.1]}
)")));
    const Robot robot = load_robot("box:0.2,0.2,0.3@0,0,0.3");
    RasterOptions options{.step = 2};
    const TerrainMap terrain = rasterize_terrain(map.geometry, frame_around(map.bounds, 0.1));
    const Picture picture = draw(raster(Judge(map, robot), options), {.robot = &robot}, terrain, map);
    CHECK(picture.at(6.9, 2) == obstacle);
    CHECK(picture.at(5.1, 2) != obstacle);
}

// ---------------------------------------------------------------- spawns

namespace {

/// Returns the polygons of an SVG picture that have this fill.
std::vector<std::vector<cv::Point2d>> polygons_of(const RasterResult& raster, const HeatmapOptions& options,
                                                  const std::string& fill)
{
    const TempFolder folder;
    write_heatmap({}, level_terrain(20, 20), raster, options, folder / "picture.svg");
    const std::string svg = bytes_of(folder / "picture.svg"), head = "<polygon points=\"";
    std::vector<std::vector<cv::Point2d>> out;
    for (std::size_t at = svg.find(head); at != std::string::npos; at = svg.find(head, at + 1)) {
        const std::size_t end = svg.find('"', at + head.size());
        if (svg.compare(end, fill.size() + 9, "\" fill=\"" + fill + "\"") != 0) continue;
        std::istringstream points(svg.substr(at + head.size(), end - at - head.size()));
        std::vector<cv::Point2d> polygon;
        char comma;
        for (cv::Point2d point; points >> point.x >> comma >> point.y;) polygon.push_back(point);
        out.push_back(polygon);
    }
    return out;
}

cv::Size2d size_of(const std::vector<cv::Point2d>& polygon)
{
    const cv::Rect_<float> box = cv::boundingRect(std::vector<cv::Point2f>(polygon.begin(), polygon.end()));
    return {box.width, box.height};
}

const std::string white_fill = "#ffffff";

}  // namespace

TEST_CASE("spawns are footprints to scale if these are at least 6 pixels long, or else arrows")
{
    const RasterResult raster = raster_of(
        {"VVVVVVVVVV", "VVVVVVVVVV", "VVVVVVVVVV", "VVVVVVVVVV", "VVVVVVVVVV"});  // 20 x 10 m
    const Robot robot = load_robot("box:2,1,0.5@0.5,0,0.25");
    HeatmapOptions options{.spawns = {{{10, 5, 0.1}, pi / 2}}, .robot = &robot};
    const Picture picture = draw(raster, options);
    const double metre = picture.plot.width / picture.view.width;
    const auto footprints = polygons_of(raster, options, white_fill);
    REQUIRE(footprints.size() >= 2);  // in the plot, in the legend, and half of the north arrow
    CHECK(size_of(footprints[0]).width == Approx(metre).margin(2));  // it faces along y
    CHECK(size_of(footprints[0]).height == Approx(2 * metre).margin(2));
    CHECK(picture.at(10, 5) == white);
    CHECK(picture.at(10, 5.8) == ink);    // the mark that shows the front
    CHECK(picture.at(10, 4.2) == valid);  // only half a metre of the robot is behind the origin
    CHECK(picture.at(10, 4.6) == white);

    // The same robot in 20 x 10 km: an arrow of the usual length.
    RasterResult large = raster;
    large.grid.x0 *= 1000, large.grid.y0 *= 1000, large.grid.step *= 1000;
    for (RasterPose& pose : large.poses) pose.x *= 1000, pose.y *= 1000;
    options.spawns[0].position *= 1000;
    CHECK(std::max(size_of(polygons_of(large, options, white_fill)[0]).height, 0.0) > 12);
    CHECK(polygons_of(large, options, white_fill)[0].size() == 4);

    // Just below and above the limit of 6 pixels.
    const Robot five = load_robot("box:" + std::to_string(5.5 / metre) + ",0.01,0.5"),
                seven = load_robot("box:" + std::to_string(7 / metre) + ",0.01,0.5");
    options.spawns[0].position /= 1000;
    options.robot = &five;
    CHECK(size_of(polygons_of(raster, options, white_fill)[0]).height > 12);
    options.robot = &seven;
    CHECK(size_of(polygons_of(raster, options, white_fill)[0]).height < 9);
}

TEST_CASE("spawns with verdicts have their colours, and the legend counts those in view")
{
    const RasterResult raster = raster_of({"AAAAA", "AAAAA", "AAAAA"});  // 10 x 6 m
    const Robot robot = load_robot("box:1,0.6,0.5");
    HeatmapOptions options{.spawns = {{{1, 1, 0}, 0}, {{5, 3, 0}, 1}, {{9, 5, 0}, 2}, {{30, 5, 0}, 2}},
                           .spawn_verdicts = {Verdict::Valid, Verdict::Collision, Verdict::Valid, Verdict::Submerged},
                           .robot = &robot};
    const Picture picture = draw(raster, options);
    CHECK(picture.at(0.9, 1.1) == valid);
    CHECK(picture.at(4.9, 2.9) == collision);
    CHECK(picture.at(9, 4.95) == valid);
    const std::vector<std::string> texts = texts_of(raster, options);
    CHECK(contains(texts, "3 of 4 spawns in view"));
    CHECK(contains(texts, "2 valid"));
    CHECK(contains(texts, "1 collision"));
    CHECK_FALSE(contains(texts, "1 submerged"));
    options.spawns.resize(3);
    options.spawn_verdicts.resize(3);
    CHECK(contains(texts_of(raster, options), "3 spawns"));
    options.spawn_verdicts.resize(2);
    CHECK_THROWS_WITH(texts_of(raster, options), Contains("size of spawn_verdicts is 2"));
}

TEST_CASE("names are written beside spawns, and names without room are counted")
{
    const RasterResult raster = raster_of({"VVVVV", "VVVVV", "VVVVV"});
    HeatmapOptions options{.spawns = {{{2, 2, 0}, 0}, {{8, 4, 0}, 1}}, .spawn_names = {"left <1>", "right"}};
    std::vector<std::string> texts = texts_of(raster, options);
    CHECK(contains(texts, "left <1>"));
    CHECK(contains(texts, "right"));
    for (int k = 0; k < 20; ++k) {
        options.spawns.push_back({{2, 2, 0}, 0});
        options.spawn_names.push_back("n" + std::to_string(k));
    }
    texts = texts_of(raster, options);
    const auto written = std::count_if(texts.begin(), texts.end(), [](const std::string& text) {
        return text.starts_with("n") && std::isdigit(text[1]);
    });
    CHECK(written < 20);
    CHECK(contains(texts, std::to_string(written + 2) + " of 22 names shown: no room"));
}

TEST_CASE("spawns of several kinds have the outline and the colour of their own kind")
{
    const RasterResult raster = raster_of(
        {"VVVVVVVVVV", "VVVVVVVVVV", "VVVVVVVVVV", "VVVVVVVVVV", "VVVVVVVVVV"});  // 20 x 10 m
    const Robot large = load_robot("box:2,1,0.5"), small = load_robot("box:0.6,1.2,0.5"),
                other = load_robot("box:3,3,1");
    HeatmapOptions options{
        .spawns = {{{4, 5, 0}, 0}, {{10, 5, 0}, 0}, {{16, 5, 0}, pi / 2}, {{99, 5, 0}, 0}},
        .spawn_names = {"a", "b", "c", "d"},
        .kinds = {{"truck", &large}, {"unused", &other}, {"cart", &small}},
        .spawn_kinds = {0, 2, 2, 2},
        .robot = &other,
    };
    const Picture picture = draw(raster, options);
    const double metre = picture.plot.width / picture.view.width;
    const auto sizes = [&](std::size_t kind) {
        char fill[8];
        std::snprintf(fill, sizeof fill, "#%06x", kind_palette[kind]);
        std::vector<cv::Size2d> out;
        for (const auto& polygon : polygons_of(raster, options, fill)) out.push_back(size_of(polygon));
        return out;
    };
    const auto check_size = [&](const cv::Size2d& size, double width, double height) {
        CHECK(size.width == Approx(width * metre).margin(2));
        CHECK(size.height == Approx(height * metre).margin(2));
    };
    const auto trucks = sizes(0), unused = sizes(1), carts = sizes(2);
    REQUIRE((trucks.size() >= 2 && carts.size() == 3));  // in the plot and in the legend; white is also elsewhere
    check_size(trucks[0], 2, 1);
    check_size(carts[0], 0.6, 1.2);
    check_size(carts[1], 1.2, 0.6);  // turned
    CHECK(unused.empty());
    CHECK(picture.at(3.3, 5) == rgb(kind_palette[0]));
    CHECK(picture.at(10, 4.6) == rgb(kind_palette[2]));
    const std::vector<std::string> texts = texts_of(raster, options);
    for (const char* const text : {"3 of 4 spawns in view", "1 truck", "2 cart", "a", "b", "c"}) {
        CAPTURE(text);
        CHECK(contains(texts, text));
    }
    CHECK_FALSE(contains(texts, "0 unused"));
    options.spawn_kinds.pop_back();
    CHECK_THROWS_WITH(texts_of(raster, options), Contains("size of spawn_kinds is 3"));
    options.spawn_kinds.push_back(3);
    CHECK_THROWS_WITH(texts_of(raster, options), Contains("spawn_kinds is 3, needs less than the number of kinds, 3"));
    options.spawn_kinds.back() = 0;
    options.spawn_verdicts.resize(4);
    CHECK_THROWS_WITH(texts_of(raster, options), Contains("spawns have one colour"));
    // More kinds than colours: the last colour is shared.
    options.spawn_verdicts.clear();
    options.kinds.assign(12, {"k", &large});
    options.spawn_kinds = {6, 7, 11, 0};
    const Picture many = draw(raster, options);
    CHECK(many.at(3.3, 5) == rgb(kind_palette[6]));
    CHECK(many.at(9.3, 5) == rgb(kind_palette[7]));
    CHECK(many.at(16, 4.3) == rgb(kind_palette[7]));
}

TEST_CASE("starts are discs, goals are diamonds, and paths are lines, each with a legend entry")
{
    const RasterResult raster = raster_of({"VVVVV", "VVVVV", "VVVVV"});  // 10 x 6 m
    HeatmapOptions options{.starts = {{1, 1, 0}, {1, 5, 0}, {50, 1, 0}},
                           .goals = {{9, 1, 0}, {9, 5, 0}},
                           .start_names = {"one", "two", "three"},
                           .paths = {{{1, 1, 0}, {5, 3, 0}, {9, 1, 0}}}};
    const Picture picture = draw(raster, options);
    for (const Vec3& start : options.starts)
        if (start.x() < 10) CHECK(picture.at(start.x(), start.y()) == rgb(start_colour));
    for (const Vec3& goal : options.goals) CHECK(picture.at(goal.x(), goal.y()) == rgb(goal_colour));
    CHECK(picture.at(3, 2) == rgb(path_colour));  // the middles of its parts
    CHECK(picture.at(7, 2) == rgb(path_colour));
    CHECK(picture.at(5, 1) == valid);
    const std::vector<std::string> texts = texts_of(raster, options);
    for (const char* const text : {"2 of 3 starts in view", "2 goals", "1 path", "one", "two"}) {
        CAPTURE(text);
        CHECK(contains(texts, text));
    }
    CHECK_FALSE(contains(texts, "three"));
    options.goal_names = {"a"};
    CHECK_THROWS_WITH(texts_of(raster, options), Contains("size of goal_names is 1"));
    options = {.paths = {{{1, 1, 0}}, {}}};
    CHECK(contains(texts_of(raster, options), "2 paths"));  // too short to be seen
}

TEST_CASE("heat maps are SVG or PDF by the file extension, with texts as text")
{
    const TempFolder folder;
    const RasterResult raster = raster_of({"VC"});
    for (const char* const name : {"a.svg", "b.svg", "a.pdf", "b.pdf"})
        write_heatmap({}, level_terrain(4, 2), raster, {.title = "two columns"}, folder / name);
    CHECK(contains(svg_texts(bytes_of(folder / "a.svg")), "two columns"));
    CHECK_THAT(pdf_page(bytes_of(folder / "a.pdf")), Contains("(two columns) Tj"));
    CHECK(bytes_of(folder / "a.svg") == bytes_of(folder / "b.svg"));
    CHECK(bytes_of(folder / "a.pdf") == bytes_of(folder / "b.pdf"));
    write_heatmap({}, level_terrain(4, 2), raster, {.format = PictureFormat::Svg}, folder / "plain");
    CHECK(bytes_of(folder / "plain").starts_with("<?xml"));
    CHECK_THROWS_AS(write_heatmap({}, level_terrain(4, 2), raster, {}, folder / "a.jpg"), ArgumentError);
    CHECK_FALSE(std::filesystem::exists(folder / "a.jpg"));
}
