#include "base/deflate.h"
#include "picture/relief.h"

#include <spawnfield/error.h>
#include <spawnfield/heatmap.h>

#include "catch.h"

#include <opencv2/imgcodecs.hpp>

#include <cmath>
#include <fstream>
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

/// Terrain over x and y from 0 to these lengths.
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
    ++raster.counts[std::size_t(verdict)];
}

/// A column for each letter, the first line at the largest y; '.' has no pose. Columns stand 2 m apart from (1, 1) on.
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

class Folder {
public:
    Folder() : path_(std::filesystem::temp_directory_path() / "spawnfield_heatmap_test") { std::filesystem::create_directories(path_); }
    ~Folder() { std::filesystem::remove_all(path_); }
    std::filesystem::path operator/(const std::string& name) const { return path_ / name; }

private:
    std::filesystem::path path_;
};

/// A picture as a reader sees it: the plot is what the frame of exactly this colour encloses.
struct Picture {
    Image image;
    cv::Rect plot;
    View view;  ///< that the plot shows

    cv::Point pixel(double x, double y) const
    {
        return {plot.x + int((x - view.x0) / view.width * plot.width),
                plot.y + int((view.y0 + view.height - y) / view.height * plot.height)};
    }
    Colour at(double x, double y) const { return image(pixel(x, y)); }
};

const Colour frame_colour = rgb(0x404040);

/// First and one past the last of the longest run of frame colour in a row.
cv::Range longest_run(const Image& image, int row)
{
    cv::Range longest(0, 0);
    for (int col = 0, first = 0; col < image.cols; ++col) {
        if (image(row, col) != frame_colour) first = col + 1;
        else if (col + 1 - first > longest.size()) longest = {first, col + 1};
    }
    return longest;
}

/// A tick at the plot's edge makes one of the frame's lines longer than the others.
cv::Rect find_plot(const Image& image)
{
    int width = 0;
    for (int row = 0; row < image.rows; ++row) width = std::max(width, longest_run(image, row).size());
    std::vector<int> rows;  // of the frame's upper and lower line
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

Picture draw(const RasterResult& raster, const HeatmapOptions& options = {}, const TerrainMap& terrain = level_terrain(20, 20))
{
    const Folder folder;
    write_heatmap({}, terrain, raster, options, folder / "picture.png");
    const RasterGrid& grid = raster.grid;
    return read_picture(folder / "picture.png", with_room({grid.x0 - grid.step / 2, grid.y0 - grid.step / 2,
                                                           grid.cols * grid.step, grid.rows * grid.step}));
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

// Okabe and Ito's palette, as they published it.
const Colour valid = rgb(0x009e73), collision = rgb(0xd55e00), submerged = rgb(0x0072b2), off_terrain = rgb(0xcc79a7),
             steep = rgb(0xe69f00), unstable = rgb(0x56b4e9),
             aerial = rgb(0xf0e442), outside = rgb(0x999999), no_pose = rgb(0xe6e6e6);

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

std::string bytes_of(const std::filesystem::path& file)
{
    std::ifstream in(file, std::ios::binary);
    std::stringstream text;
    text << in.rdbuf();
    return text.str();
}

}  // namespace

TEST_CASE("each column has its verdict's colour, up to its edges, where it stands")
{
    const Drawing drawing = GENERATE(Drawing{"VCSOA",
                                             "X.VVC",
                                             "SSVOO"},
                                     Drawing{"VTUCS"},
                                     Drawing{"CVVVVVVVVVVS"}, Drawing{"C", "V", "V", "S", "."}, Drawing{"O"});
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

TEST_CASE("the longer side of a picture is as asked, and nothing in it is cut off")
{
    const auto [cols, rows] = GENERATE(table<int, int>({{1, 1}, {6, 1}, {1, 6}, {40, 1}, {1, 40}, {7, 4}}));
    const int pixels = GENERATE(200, 1000, 2000);
    const auto quantity = GENERATE(HeatmapQuantity::Verdict, HeatmapQuantity::Height);
    RasterResult raster = raster_of(Drawing(std::size_t(rows), std::string(std::size_t(cols), 'V')));
    raster.counts[0] = 1234567;
    const std::string title = "a title that is so long that a narrow picture has to make room for it";
    const Picture picture = draw(raster, {.quantity = quantity, .pixels = pixels, .title = title});

    CAPTURE(cols, rows, pixels);
    const Image& image = picture.image;
    CHECK(std::max(image.cols, image.rows) == pixels);
    int coloured = 0;
    for (int row = 0; row < image.rows; ++row) coloured += image(row, 0) != white || image(row, image.cols - 1) != white;
    for (int col = 0; col < image.cols; ++col) coloured += image(0, col) != white || image(image.rows - 1, col) != white;
    CHECK(coloured == 0);
    CHECK(double(picture.plot.width) / picture.plot.height ==
          Approx(picture.view.width / picture.view.height).epsilon(0.1));  // whole pixels
}

TEST_CASE("the legend shows every verdict that a two-dimensional raster may have")
{
    const Picture picture = draw(raster_of({"V"}));
    for (const Colour& colour : {valid, collision, submerged, off_terrain}) CHECK(count_outside_plot(picture, colour) > 300);
    for (const Colour& colour : {aerial, outside, steep, unstable, no_pose})
        CHECK(count_outside_plot(picture, colour) < 100);  // edges of texts are grey
}

TEST_CASE("the legend shows rare verdicts and columns without terrain where there are any")
{
    const Picture picture = draw(raster_of({"VXATU."}));
    for (const Colour& colour : {aerial, outside, steep, unstable, no_pose}) CHECK(count_outside_plot(picture, colour) > 300);
}

TEST_CASE("a column is valid if any of its poses is, else as the topmost says")
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
    raster.counts[std::size_t(Verdict::Aerial)] = 12;
    const Picture picture = draw(raster);
    CHECK(picture.at(1, 1) == valid);
    CHECK(picture.at(3, 1) == aerial);
}

TEST_CASE("ground that faces north-west is lighter than ground that faces south-east, in the same hue")
{
    const auto roof = [](double x, double y) { return float(-0.5 * std::abs((x - 5) - (y - 5))); };  // ridge from SW to NE
    const Picture picture = draw(raster_of({"VVVVV", "VVVVV", "VVVVV", "VVVVV", "VVVVV"}), {}, terrain_of(10, 10, roof));
    const Colour lit = picture.at(2, 8), dark = picture.at(8, 2);
    CHECK(brightness(lit) > brightness(valid));
    CHECK(brightness(dark) < brightness(valid));
    for (const Colour& colour : {lit, dark}) {
        CHECK(colour[1] > colour[0]);  // green over blue over red
        CHECK(colour[0] > colour[2]);
    }
}

TEST_CASE("an arrow stands where a spawn is and points along its yaw")
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

TEST_CASE("clearance grows from the border and from columns that are not valid")
{
    const Picture picture = draw(raster_of({"VVVVVVV", "VVVVVVV", "VVVVVVV", "VVVCVVV", "VVVVVVV", "VVVVVVV", "VVVVVVV"}),
                                 {.quantity = HeatmapQuantity::Clearance});
    const Ramp ramp = viridis();
    const auto colour = [&](double clearance) { return ramp[std::size_t(std::lround(clearance / 4 * 255))]; };  // scale: 0 .. 4 m
    CHECK(picture.at(1, 1) == colour(2));
    CHECK(picture.at(3, 3) == colour(4));
    CHECK(picture.at(5, 7) == colour(2));
    CHECK(picture.at(5, 5) == colour(std::sqrt(8)));
    CHECK(picture.at(7, 7) == rgb(0x9a9a9a));
}

TEST_CASE("height shows the pose that the column is known by")
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

TEST_CASE("slope is that of the top layer below the column")
{
    const auto ground = [](double, double y) { return y < 6 ? 0.0f : float(y - 6); };
    const Picture picture =
        draw(raster_of({"V", "V", "V", "V", "V", "V"}), {.quantity = HeatmapQuantity::Slope}, terrain_of(2, 12, ground));
    CHECK(picture.at(1, 1) == viridis().front());
    const Colour steep = viridis()[std::size_t(std::lround(45.0 / 50 * 255))], seen = picture.at(1, 11);  // shaded, so only like it
    for (int c = 0; c < 3; ++c) CHECK(std::abs(seen[c] - steep[c]) < 60);
}

TEST_CASE("a gradient is one-sided beside a hole and nothing in it")
{
    HeightImage heights(3, 3);
    heights << 4, 5, 6,  //
        2, 3, nothing,   //
        0, 1, 2;
    CHECK(gradient(heights, 1, 1, 0.5).isApprox(Eigen::Vector2d(2, 4)));
    CHECK(gradient(heights, 0, 0, 0.5).isApprox(Eigen::Vector2d(2, 4)));
    CHECK(gradient(heights, 1, 2, 0.5).hasNaN());
}

TEST_CASE("options and rasters out of range are named with their limits")
{
    const Folder folder;
    const TerrainMap terrain = level_terrain(2, 2);
    RasterResult raster = raster_of({"V"});
    const auto write = [&](const HeatmapOptions& options) { write_heatmap({}, terrain, raster, options, folder / "a.png"); };
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
    const Folder folder;
    const TerrainMap terrain = terrain_of(6, 4, [](double x, double y) { return float(std::sin(x) * y); });
    const RasterResult raster = raster_of({"VCS", "OV."});
    for (const char* name : {"a.png", "b.png"})
        write_heatmap({}, terrain, raster, {.spawns = {{{1, 1, 0}, 0.3}}, .title = "twice"}, folder / name);
    CHECK(!bytes_of(folder / "a.png").empty());
    CHECK((bytes_of(folder / "a.png") == bytes_of(folder / "b.png")));
}

TEST_CASE("a picture that cannot be written is an OutputError")
{
    const Folder folder;
    CHECK_THROWS_AS(write_heatmap({}, level_terrain(2, 2), raster_of({"V"}), {}, folder / "missing/a.png"), OutputError);
}

TEST_CASE("a preview shows terrain by height, obstacles grey, water blue and nothing white")
{
    // From left to right: low ground, high ground, a block on the ground, a lake, nothing, a block in the air, a pier.
    const auto ground = [](double x, double) { return x < 4 ? 0.0f : x < 12 ? 2.0f : x < 16 ? -1.0f : nothing; };
    const auto obstacle = [](double x, double) { return x > 8 && x < 12 ? 5.0f : x > 20 && x < 24 ? 4.0f : x > 24 ? 3.0f : nothing; };
    TerrainMap terrain = terrain_of(28, 8, ground);
    add_page(terrain, "obstacle", obstacle);
    add_page(terrain, "water", [](double x, double) { return (x > 12 && x < 16) || x > 24 ? 1.0f : nothing; });
    const Folder folder;
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
