#include "base/tiff.h"
#include "catch.h"
#include "program.h"
#include "scene_text.h"
#include "shared_scenes.h"
#include "test_map.h"

#include <spawnfield/column.h>
#include <spawnfield/error.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <sstream>

using namespace spawnfield;

namespace {

constexpr double hole = std::numeric_limits<double>::quiet_NaN();

using Doubles = std::vector<double>;
using Keys = std::vector<std::uint16_t>;

/// Returns GeoKeys whose values are in the directory itself.
Keys keys_of(const std::vector<std::pair<int, int>>& entries)
{
    Keys keys{1, 1, 0, std::uint16_t(entries.size())};
    for (const auto& [id, value] : entries) keys.insert(keys.end(), {std::uint16_t(id), 0, 1, std::uint16_t(value)});
    return keys;
}

const Keys utm = keys_of({{1024, 1}, {1025, 1}, {3072, 32611}, {3076, 9001}});

/// A GeoTIFF with 3 x 2 float heights of 1 .. 6. Its upper left corner is at 500000, 4000010, and its cells are 2 x 5
/// m.
struct GeoFile {
    std::uint32_t cols = 3;
    Doubles heights{1, 2, 3, 4, 5, 6};
    int bits = 32, format = SAMPLEFORMAT_IEEEFP;
    Doubles scale{2, 5, 0}, tie{0, 0, 0, 500000, 4000010, 0}, transformation{}, doubles{};
    Keys keys = utm;
    std::string ascii = "", no_data = "", metadata = "";
    int photometric = PHOTOMETRIC_MINISBLACK;
};

template <class T>
void set(TIFF* tiff, std::uint32_t tag, const std::vector<T>& values)
{
    if (!values.empty()) REQUIRE(TIFFSetField(tiff, tag, std::uint32_t(values.size()), values.data()) == 1);
}

void set(TIFF* tiff, std::uint32_t tag, const std::string& text)
{
    if (!text.empty()) REQUIRE(TIFFSetField(tiff, tag, text.c_str()) == 1);
}

std::filesystem::path write(const TempFolder& folder, const GeoFile& geo, const std::string& name = "a.tif")
{
    const std::filesystem::path file = folder / name;
    const Tiff tiff = open_tiff(file, "w");
    REQUIRE(tiff);
    const auto rows = std::uint32_t(geo.heights.size()) / geo.cols;
    for (const auto& [tag, value] : {std::pair<std::uint32_t, std::uint32_t>{TIFFTAG_IMAGEWIDTH, geo.cols},
                                     {TIFFTAG_IMAGELENGTH, rows},
                                     {TIFFTAG_BITSPERSAMPLE, geo.bits},
                                     {TIFFTAG_SAMPLEFORMAT, geo.format},
                                     {TIFFTAG_SAMPLESPERPIXEL, 1},
                                     {TIFFTAG_PHOTOMETRIC, geo.photometric},
                                     {TIFFTAG_ROWSPERSTRIP, 1}})
        TIFFSetField(tiff.get(), tag, value);
    set(tiff.get(), 33550, geo.scale);
    set(tiff.get(), 33922, geo.tie);
    set(tiff.get(), 34264, geo.transformation);
    set(tiff.get(), 34735, geo.keys);
    set(tiff.get(), 34736, geo.doubles);
    set(tiff.get(), 34737, geo.ascii);
    set(tiff.get(), 42112, geo.metadata);
    set(tiff.get(), 42113, geo.no_data);
    for (std::uint32_t row = 0; row < rows; ++row) {
        std::string bytes;
        const auto add = [&](auto typed) { bytes.append(reinterpret_cast<const char*>(&typed), sizeof typed); };
        for (std::uint32_t col = 0; col < geo.cols; ++col) {
            const double z = geo.heights[row * geo.cols + col];
            if (geo.format == SAMPLEFORMAT_IEEEFP && geo.bits == 64)
                add(z);
            else if (geo.format == SAMPLEFORMAT_IEEEFP)
                add(float(z));
            else if (geo.bits == 16)
                add(std::uint16_t(std::int64_t(z)));
            else
                add(std::uint32_t(std::int64_t(z)));
        }
        REQUIRE(TIFFWriteScanline(tiff.get(), bytes.data(), row) == 1);
    }
    return file;
}

bool has_ground(const Scene& scene, double x, double y) { return !column_at(Geometry(scene), x, y).layers.empty(); }

double height(const Scene& scene, double x, double y)
{
    const Column column = column_at(Geometry(scene), x, y);
    REQUIRE(column.layers.size() == 1);
    return column.layers[0];
}

/// Checks the survey coordinates of the point 0, 0 of the scene.
void check_origin(const Scene& scene, double x, double y, const std::string& crs)
{
    REQUIRE(scene.origin);
    CHECK(scene.origin->x == Approx(x).epsilon(1e-15));
    CHECK(scene.origin->y == Approx(y).epsilon(1e-15));
    CHECK(scene.origin->crs == crs);
}

bool has_notice(const Scene& scene, const std::string& text)
{
    return std::any_of(scene.notices.begin(), scene.notices.end(),
                       [&](const std::string& notice) { return notice.find(text) != std::string::npos; });
}

const std::string item = "<GDALMetadata><Item name=\"UNITTYPE\" sample=\"0\" role=\"unittype\">";
const std::string grid_head = "ncols 3\nnrows 2\nxllcorner 500000\nyllcorner 4000000\ncellsize 5\n";

}  // namespace

TEST_CASE("a GeoTIFF as a scene is terrain around 0, 0, and the scene stores the survey coordinates of that point")
{
    const TempFolder folder;
    const Scene scene = load_scene(write(folder, {}));
    CHECK(scene.name == "a");
    REQUIRE(scene.parts.size() == 1);
    CHECK(scene.parts[0].label == Label::Terrain);
    CHECK(scene.triangles.size() == 4);
    CHECK(scene.bounds().min == Vec3(-2, -2.5, 1));
    CHECK(scene.bounds().max == Vec3(2, 2.5, 6));
    CHECK(height(scene, -2, 2.5) == 1);  // the north-western pixel
    CHECK(height(scene, 2, 2.5) == 3);
    CHECK(height(scene, -2, -2.5) == 4);
    check_origin(scene, 500003, 4000005, "EPSG:32611");
    CHECK(has_notice(scene, "x 500003, y 4000005 (EPSG:32611) is at 0, 0 of the scene"));
    CHECK(scene.notices.size() == 1);
}

TEST_CASE("pixels are areas with their heights in the middle, or points with their heights at the corner")
{
    const TempFolder folder;
    const Keys points = keys_of({{1024, 1}, {1025, 2}, {3072, 32611}, {3076, 9001}});
    check_origin(load_scene(write(folder, {.keys = points})), 500002, 4000007.5, "EPSG:32611");
    check_origin(load_scene(write(folder, {.tie = {1, 2, 0, 500002, 4000000, 0}})), 500003, 4000005, "EPSG:32611");
    const Doubles affine{2, 0, 0, 500000, 0, -5, 0, 4000010, 0, 0, 0, 0, 0, 0, 0, 1};
    const Scene scene = load_scene(write(folder, {.scale = {}, .tie = {}, .transformation = affine}));
    check_origin(scene, 500003, 4000005, "EPSG:32611");
    CHECK(height(scene, -2, 2.5) == 1);
}

TEST_CASE("heights of all kinds of pixels are metres")
{
    const TempFolder folder;
    const auto [bits, format] = GENERATE(std::pair{16, SAMPLEFORMAT_INT}, std::pair{32, SAMPLEFORMAT_INT},
                                         std::pair{32, SAMPLEFORMAT_IEEEFP}, std::pair{64, SAMPLEFORMAT_IEEEFP});
    CAPTURE(bits, format);
    const Scene below = load_scene(write(folder, {.heights = {-7, -6, -5, 400, 5, 6}, .bits = bits, .format = format}));
    CHECK(height(below, -2, 2.5) == -7);
    CHECK(height(below, -2, -2.5) == 400);
    const Scene whole = load_scene(
        write(folder, {.heights = {7, 6, 5, 40000, 5, 6}, .bits = 16, .format = SAMPLEFORMAT_UINT}));
    CHECK(height(whole, -2, -2.5) == 40000);
    CHECK(has_notice(whole, "heights are whole numbers, taken as metres"));
    SceneOptions options{.heightmap = "z: [0, 65.535]"};
    CHECK(height(load_scene(folder / "a.tif", options), -2, -2.5) == Approx(40));
}

TEST_CASE("feet become metres, with a notice")
{
    const TempFolder folder;
    const Scene feet = load_scene(
        write(folder, {.keys = keys_of({{1024, 1}, {3072, 2225}, {3076, 9003}, {4099, 9002}})}));
    constexpr double foot = 1200.0 / 3937;
    CHECK(feet.bounds().max.x() == Approx(2 * foot));
    CHECK(feet.bounds().max.z() == Approx(6 * 0.3048));
    check_origin(feet, 500003, 4000005, "EPSG:2225");
    CHECK(feet.origin->unit == foot);
    CHECK(has_notice(feet, "x and y are in units of 0.304800609601"));
    CHECK(has_notice(feet, "heights are in units of 0.3048 m"));

    Keys own = keys_of({{1024, 1}, {3076, 32767}});
    own[3] = 3;
    own.insert(own.end(), {3077, 34736, 1, 1});
    CHECK(load_scene(write(folder, {.doubles = {7, 0.5}, .keys = own})).bounds().max.x() == 1);

    const Scene unknown = load_scene(write(folder, {.keys = keys_of({{1024, 1}})}));
    CHECK(unknown.bounds().max.x() == 2);
    CHECK(has_notice(unknown, "does not state the unit of x and y; they are taken as metres"));
    CHECK(load_scene(write(folder, {.metadata = item + "ft</Item></GDALMetadata>"})).bounds().max.z() ==
          Approx(6 * 0.3048));
    CHECK(load_scene(write(folder, {.metadata = item + "metre</Item></GDALMetadata>"})).bounds().max.z() == 6);
}

TEST_CASE("without a key for the unit, x and y have the unit of the EPSG code, and nothing is assumed")
{
    const TempFolder folder;
    // Files like those of GDAL 3.6 for EPSG:2263+6360 and, with GEOTIFF_VERSION=1.1, for EPSG:2263. Units are those
    // that gdalinfo prints.
    const auto [code, unit] = GENERATE(std::pair{2263, 1200.0 / 3937}, std::pair{2222, 0.3048}, std::pair{25832, 1.0},
                                       std::pair{3035, 1.0}, std::pair{2193, 1.0}, std::pair{3167, 20.116756},
                                       std::pair{7405, 1.0});
    CAPTURE(code);
    const Scene scene = load_scene(write(folder, {.keys = keys_of({{1024, 1}, {3072, code}})}));
    CHECK(scene.bounds().max.x() == Approx(2 * unit).epsilon(1e-12));
    CHECK(scene.bounds().max.y() == Approx(2.5 * unit).epsilon(1e-12));
    check_origin(scene, 500003, 4000005, "EPSG:" + std::to_string(code));
    CHECK_FALSE(has_notice(scene, "taken as metres"));
    CHECK(has_notice(scene, "x and y are in units of ") == (unit != 1));
    // A key for the unit takes precedence, as in GDAL.
    CHECK(load_scene(write(folder, {.keys = keys_of({{1024, 1}, {3072, code}, {3076, 9001}})})).bounds().max.x() == 2);
}

TEST_CASE("heights have the unit of the EPSG code of their vertical system")
{
    const TempFolder folder;
    const auto [code, unit] = GENERATE(std::pair{8228, 0.3048}, std::pair{6360, 1200.0 / 3937}, std::pair{5703, 1.0},
                                       std::pair{5730, 1.0}, std::pair{4979, 1.0});
    CAPTURE(code);
    const Scene scene = load_scene(write(folder, {.keys = keys_of({{1024, 1}, {3072, 26910}, {4096, code}})}));
    CHECK(scene.bounds().max.x() == 2);
    CHECK(scene.bounds().min.z() == Approx(unit).epsilon(1e-12));
    CHECK(scene.bounds().max.z() == Approx(6 * unit).epsilon(1e-12));
    CHECK(has_notice(scene, "heights are in units of ") == (unit != 1));
    CHECK(scene.notices.size() == (unit == 1 ? 1 : 2));
}

TEST_CASE("if the units of heights disagree, the first in the order of GDAL counts, with a notice")
{
    const TempFolder folder;
    const bool by_band = GENERATE(false, true);
    const std::string metadata = by_band ? item + "m</Item></GDALMetadata>" : "";
    const Scene scene = load_scene(
        write(folder, {.keys = keys_of({{1024, 1}, {3072, 26910}, {4096, 6360}, {4099, 9001}}), .metadata = metadata}));
    CHECK(scene.bounds().max.z() == Approx(by_band ? 6 : 6 * 1200.0 / 3937));
    CHECK(has_notice(
        scene, by_band
                   ? "heights are in units of 1 m by \"m\", but of 0.30480060960121924 m by "
                     "EPSG:6360 (VerticalGeoKey); the first is used"
                   : "m by EPSG:6360 (VerticalGeoKey), but of 1 m by 9001 (VerticalUnitsGeoKey); the first is used"));
    CHECK_FALSE(has_notice(load_scene(write(folder, {.keys = keys_of({{1024, 1}, {3072, 26910}, {4096, 6360}}),
                                                     .metadata = item + "ft</Item></GDALMetadata>"})),
                           "says that"));
    // An unknown vertical system does not matter if the unit is given.
    CHECK(load_scene(write(folder, {.keys = keys_of({{1024, 1}, {3072, 26910}, {4096, 5199}, {4099, 9002}})}))
              .bounds()
              .max.z() == Approx(6 * 0.3048));
}

TEST_CASE("depths become negative heights, with a notice")
{
    const TempFolder folder;
    const GeoFile geo{.heights = {1, 2, -9999, 4, 5, 6},
                      .keys = keys_of({{1024, 1}, {3072, 32633}, {4096, 5336}}),
                      .no_data = "-9999"};
    const Scene scene = load_scene(write(folder, geo));
    CHECK(scene.bounds().min.z() == -6);
    CHECK(scene.bounds().max.z() == -1);
    CHECK(height(scene, -2, 2.5) == -1);
    CHECK(scene.triangles.size() == 3);
    CHECK(has_notice(
        scene, "its values are depths (EPSG:5336 (VerticalGeoKey) counts downwards); heights are their negatives"));
}

TEST_CASE("tiles have the same unit in whichever way they state it")
{
    const TempFolder folder;
    write(folder, {.keys = keys_of({{1024, 1}, {3072, 2263}, {3076, 9003}})}, "w.tif");
    write(folder, {.tie = {0, 0, 0, 500004, 4000010, 0}, .keys = keys_of({{1024, 1}, {3072, 2263}})}, "e.tif");
    const std::string origin = ", origin: [500005, 4000005]}}\n";
    const Scene scene = load_parts(folder, "  - {name: w, label: terrain, heightmap: {file: w.tif" + origin +
                                               "  - {name: e, label: terrain, heightmap: {file: e.tif" + origin);
    CHECK_FALSE(has_notice(scene, "an earlier part"));
}

TEST_CASE("EPSG codes without a unit are refused, with advice")
{
    const TempFolder folder;
    const auto check_refused = [&](int code, const std::string& reason) {
        CHECK_THROWS_WITH(load_scene(write(folder, {.keys = keys_of({{1024, 1}, {3072, code}})})),
                          (folder / "a.tif").string() + ": " + reason);
    };
    check_refused(4326,
                  "has coordinates in degrees (geographic, EPSG:4326), needs metres; reproject it: gdalwarp -t_srs "
                  "EPSG:CODE, where "
                  "CODE is a projection in metres, such as that of the UTM zone");
    CHECK_THROWS_WITH(load_scene(write(folder, {.keys = keys_of({{1024, 1}, {3072, 4978}})})),
                      Contains("(geocentric, EPSG:4978)"));
    for (const int code : {30000, 5703})  // none, heights alone
        check_refused(
            code,
            "is in EPSG:" + std::to_string(code) +
                ", which PROJ does not know as a projection, so its unit is unknown; give it another with gdal_edit.py "
                "-a_srs, or give the spacing in metres with the key cell");
    SceneOptions options{.heightmap = "cell: 3"};
    CHECK(load_scene(folder / "a.tif", options).bounds().max.x() == 3);
}

TEST_CASE("without an EPSG code the scene keeps the description of the survey")
{
    const TempFolder folder;
    Keys keys = keys_of({{1024, 1}, {3072, 32767}, {3076, 9001}});
    keys[3] = 4;
    keys.insert(keys.end(), {1026, 34737, 9, 3});
    check_origin(load_scene(write(folder, {.keys = keys, .ascii = "no|my \1plan|more|"})), 500003, 4000005, "my plan");
}

TEST_CASE("no-data heights are not terrain")
{
    const TempFolder folder;
    const auto check_hole = [&](const Scene& scene) {
        CHECK(scene.triangles.size() == 3);
        CHECK_FALSE(has_ground(scene, 1.9, 2.4));
        CHECK(has_ground(scene, 1.9, -2.4));
        CHECK(scene.bounds().max.z() == 6);
        CHECK(has_notice(scene, "1 of 6 heights are missing"));
    };
    const Doubles heights{1, 2, -9999, 4, 5, 6};
    check_hole(load_scene(write(folder, {.heights = heights, .no_data = "-9999"})));
    check_hole(load_scene(
        write(folder, {.heights = heights, .bits = 16, .format = SAMPLEFORMAT_INT, .no_data = " -9999.0 "})));
    check_hole(load_scene(write(folder, {.heights = {1, 2, hole, 4, 5, 6}, .no_data = "nan"})));
    // Text and pixel differ by rounding: GDAL writes all decimals of the float, other programs write fewer.
    check_hole(
        load_scene(write(folder, {.heights = {1, 2, -3.4028234663852886e38, 4, 5, 6}, .no_data = "-3.4028235e+38"})));
    // A value beyond the range of float was stored as infinity; a double can store it.
    constexpr double infinite = std::numeric_limits<double>::infinity();
    const GeoFile beyond{.heights = {1, 2, -infinite, 4, 5, 6}, .no_data = "-1e+100"};
    check_hole(load_scene(write(folder, beyond)));
    const auto check_infinite = [&](GeoFile geo) {
        CHECK_THROWS_WITH(load_scene(write(folder, geo)), Contains("row 0, column 2 is infinite"));
    };
    GeoFile wrong = beyond;
    wrong.heights[2] = infinite;
    check_infinite(wrong);
    wrong = beyond;
    wrong.bits = 64;
    check_infinite(wrong);
    wrong = beyond;
    wrong.no_data = "-9999";
    check_infinite(wrong);
    const std::filesystem::path plain = write(folder, {.heights = heights});
    const Scene deep = load_scene(plain);
    CHECK(deep.bounds().min.z() == -9999);
    CHECK(has_notice(
        deep,
        "the lowest height is -9999 m, which often means no data; if it does here, give --heightmap 'nodata: -9999'"));
    for (const int system : {8228, 5336})  // feet, depths
        CHECK(has_notice(
            load_scene(write(folder, {.heights = heights, .keys = keys_of({{1024, 1}, {3072, 26910}, {4096, system}})},
                             "b.tif")),
            "the lowest value is -9999, which often means no data; if it does here, give --heightmap 'nodata: -9999'"));
    SceneOptions options{.heightmap = "nodata: -9999"};
    check_hole(load_scene(plain, options));
    CHECK_THROWS_WITH(load_scene(write(folder, {.heights = {0, 0, 0, 0, 0, 0}, .no_data = "0"})),
                      (folder / "a.tif").string() + ": has no heights: every pixel is NaN or no-data");
}

TEST_CASE("where 0 is white a GeoTIFF keeps its values, but in a plain picture white is high")
{
    const TempFolder folder;
    const Doubles heights{1, 2, 65535, 4, 5, 6};
    const GeoFile survey{.heights = heights,
                         .bits = 16,
                         .format = SAMPLEFORMAT_UINT,
                         .no_data = "65535",
                         .photometric = PHOTOMETRIC_MINISWHITE};
    const Scene scene = load_scene(write(folder, survey));
    CHECK(scene.bounds().min.z() == 1);
    CHECK(scene.bounds().max.z() == 6);
    CHECK(height(scene, -2, 2.5) == 1);
    CHECK(scene.triangles.size() == 3);
    SceneOptions options{.heightmap = "z: [0, 655.35]"};
    CHECK(load_scene(folder / "a.tif", options).bounds().max.z() == Approx(0.06));
    GeoFile picture = survey;
    picture.scale = picture.tie = {};
    picture.keys = {};
    options.heightmap = "cell: 1, z: [0, 655.35]";
    const Scene white = load_scene(write(folder, picture), options);
    CHECK(white.triangles.size() == 3);  // no-data is compared with the stored value
    CHECK(white.bounds().max.z() == Approx(655.34));
    CHECK(height(white, -1, 0.5) == Approx(655.34));
}

TEST_CASE("GeoTIFFs that cannot be converted to metres are refused, with advice")
{
    const TempFolder folder;
    const std::string start = (folder / "a.tif").string() + ": ";
    const std::string known_units =
        ", needs metres (9001), kilometres (9036) or feet (9002, 9003); set the unit with gdal_edit.py -units m or ft";
    const auto check_refused = [&](const GeoFile& geo, const std::string& reason) {
        CHECK_THROWS_WITH(load_scene(write(folder, geo)), start + reason);
    };
    check_refused({.keys = keys_of({{1024, 2}, {2048, 4326}})},
                  "has coordinates in degrees (geographic, EPSG:4326), needs metres; reproject it: gdalwarp -t_srs "
                  "EPSG:CODE, where "
                  "CODE is a projection in metres, such as that of the UTM zone");
    CHECK_THROWS_WITH(load_scene(write(folder, {.keys = keys_of({{1024, 3}})})), Contains("geocentric"));
    check_refused({.scale = {0.001, 0.001, 0}, .tie = {0, 0, 0, -113.5, 48.25, 0}, .keys = {}},
                  "has cells of 0.001 at x -113.4995, y 48.2495, which look like degrees, needs metres; reproject it "
                  "(gdalwarp -t_srs EPSG:32612 "
                  "IN OUT.tif), or give the spacing in metres with the key cell");
    check_refused(
        {.scale = {}, .tie = {}, .transformation = {2, 0.1, 0, 5, 0, -5, 0, 4, 0, 0, 0, 0, 0, 0, 0, 1}},
        "is rotated against its coordinates (ModelTransformation), needs rows from west to east; gdalwarp turns it");
    check_refused(
        {.scale = {}, .tie = {}, .transformation = {2, 0, 0, 5, 0, 5, 0, 4, 0, 0, 0, 0, 0, 0, 0, 1}},
        "has a pixel scale of 2, -5, needs > 0: rows from west to east, the northern one first; gdalwarp turns it");
    check_refused({.scale = {}},
                  "has 1 tie points and no pixel scale (ModelPixelScale), needs one of each, or a ModelTransformation; "
                  "gdalwarp writes them");
    check_refused(
        {.scale = {0, 5, 0}},
        "has a pixel scale of 0, 5, needs > 0: rows from west to east, the northern one first; gdalwarp turns it");
    check_refused({.tie = {0, 0, 0, hole, 5, 0}}, "has a position or pixel scale that is not finite");
    check_refused(
        {.keys = keys_of({{1024, 1}, {3076, 9005}})},
        "has x and y in the unit 9005 (ProjLinearUnitsGeoKey), needs metres (9001), kilometres (9036) or feet "
        "(9002, 9003); reproject it with gdalwarp -t_srs");
    check_refused({.keys = keys_of({{1024, 1}, {3076, 9001}, {4099, 9010}})},
                  "has heights in the unit 9010 (VerticalUnitsGeoKey)" + known_units);
    check_refused({.keys = keys_of({{1024, 1}, {3072, 32611}, {4096, 5199}})},
                  "has heights in the unit EPSG:5199 (VerticalGeoKey)" + known_units);
    check_refused(
        {.keys = keys_of({{1024, 1}, {3072, 32611}, {4096, 3855}}), .metadata = item + "cm</Item></GDALMetadata>"},
        "has heights in the unit \"cm\"" + known_units);
    check_refused({.keys = keys_of({{1024, 1}, {1025, 5}})},
                  "has GTRasterTypeGeoKey 5, needs 1 (pixels are areas) or 2 (points)");
    check_refused({.keys = {1, 1, 0, 2, 1024, 0, 1, 1}}, "has an incomplete GeoKeyDirectory; is it cut short?");
    check_refused({.no_data = "none"}, "has a GDAL_NODATA of \"none\", needs a number");
    check_refused({.metadata = "<Item name=\"SCALE\" sample=\"0\" role=\"scale\">0.1</Item>"},
                  "has heights with a scale of 0.1, needs heights without scale and offset; gdal_translate -unscale "
                  "-ot Float32 applies them");
    check_refused({.cols = 6}, "has 6 x 1 pixels, needs at least 2 x 2");
    check_refused({.scale = {}, .tie = {}, .keys = {}},
                  "does not state its size; give --heightmap 'size: [X, Y]' (m from first to last pixel centre), or "
                  "cell (m between two pixels)");
}

TEST_CASE("a given spacing is used, and the position of the file is ignored")
{
    const TempFolder folder;
    write(folder, {.keys = keys_of({{1024, 2}})});
    SceneOptions options{.heightmap = "cell: [10, 20]"};
    const Scene scene = load_scene(folder / "a.tif", options);
    CHECK(scene.bounds().max == Vec3(10, 10, 6));
    CHECK_FALSE(scene.origin);
    options.heightmap = "cell: 10";
    CHECK(load_scene(folder / "a.tif", options).bounds().max == Vec3(10, 5, 6));
}

TEST_CASE("elevation models with one common origin keep their relative positions")
{
    const TempFolder folder;
    write(folder, {}, "west.tif");
    write(folder, {.heights = {3, 30, 31, 6, 60, 61}, .tie = {0, 0, 0, 500004, 4000010, 0}},
          "east.tif");  // shares a column of pixels with west.tif
    const std::string west = "  - {name: w, label: terrain, heightmap: {file: west.tif",
                      east = "  - {name: e, label: terrain, heightmap: {file: east.tif";
    const std::string origin = ", origin: [500005, 4000005]}";
    const Scene joined = load_parts(folder, west + origin + "}\n" + east + origin + "}\n");
    CHECK(joined.bounds().min == Vec3(-4, -2.5, 1));
    CHECK(joined.bounds().max == Vec3(4, 2.5, 61));
    CHECK(column_at(Geometry(joined), -2, 2.5).layers == Doubles{2});
    CHECK(column_at(Geometry(joined), 2, 2.5).layers == Doubles{30});
    check_origin(joined, 500005, 4000005, "EPSG:32611");
    CHECK_FALSE(has_notice(joined, "an earlier part"));
    const Scene moved = load_parts(folder, west + "}, xyz: [10, 20, 0]}\n");
    check_origin(moved, 499993, 3999985, "EPSG:32611");
    CHECK_FALSE(load_parts(folder, west + "}, rpy_deg: [0, 0, 90]}\n").origin);
    const Scene apart = load_parts(folder, west + "}}\n" + east + "}}\n");
    CHECK(has_notice(apart,
                     "part \"e\": x 500007, y 4000005 (EPSG:32611) is at 0, 0 of the scene, but an earlier part has x "
                     "500003, y 4000005 (EPSG:32611) there"));
    CHECK_THROWS_WITH(
        load_parts(folder, west + ", size: [1, 1]" + origin + "}\n"),
        Contains("heightmap.origin is only for a file that states its place, without the keys size and cell"));
    CHECK_THROWS_WITH(load_parts(folder, west + ", size: [1, 1], cell: 1}}\n"),
                      Contains("heightmap.cell is given together with size, needs only one of them"));
}

TEST_CASE("an ESRI ASCII grid is read with any case and order of its header")
{
    const TempFolder folder;
    const std::string text = GENERATE(
        "ncols 3\nnrows 2\nxllcorner 500000\nyllcorner 4000000\ncellsize 5\n1 2 3\n4 5 6\n",
        "NROWS 2\r\nNCOLS 3\r\nCELLSIZE 5.0\r\nYLLCENTER 4000002.5\r\nXLLCENTER 500002.5\r\nNODATA_value -1\r\n1 2 "
        "3\r\n4 5 6\r\n",
        "NoData_Value 77\nncols 3 nrows 2\n\ndx 5 dy 5 xllCorner 5e5\tyllCenter 4000002.5\n 1 2\n3 4 5 +6",
        "xllcorner 500000 ncols 3\n"
        "yllcorner 4000000\nnrows 2\ncellsize 5\nNODATA_value nan\n1\n2\n3\n4\n5\n6\n");
    CAPTURE(text);
    const Scene scene = load_scene(folder.write("a.asc", text));
    CHECK(scene.bounds().min == Vec3(-5, -2.5, 1));
    CHECK(height(scene, -5, 2.5) == 1);
    CHECK(height(scene, 5, -2.5) == 6);
    check_origin(scene, 500007.5, 4000005, "");
}

namespace {

/// The text that GDAL 3.6 writes beside an ESRI ASCII grid, without the parameters that have no effect on units.
const std::string gcs_of_prj =
    "GEOGCS[\"GCS_WGS_1984\",DATUM[\"D_WGS_1984\",SPHEROID[\"WGS_1984\",6378137.0,298.257223563]],PRIMEM[\"Greenwich\","
    "0.0],"
    "UNIT[\"Degree\",0.0174532925199433]]";

std::string prj(const std::string& unit)
{
    return "PROJCS[\"Plan\"," + gcs_of_prj +
           ",PROJECTION[\"Transverse_Mercator\"],PARAMETER[\"False_Easting\",500000.0],PARAMETER[\"False_Northing\",0."
           "0],"
           "PARAMETER[\"Central_Meridian\",9.0],PARAMETER[\"Scale_Factor\",0.9996],PARAMETER[\"Latitude_Of_Origin\",0."
           "0],UNIT[" +
           unit + "]]";
}

std::string vertical_prj(const std::string& direction, const std::string& unit)
{
    return ",VERTCS[\"Ups\",VDATUM[\"Here\"],PARAMETER[\"Vertical_Shift\",0.0],PARAMETER[\"Direction\"," + direction +
           "],UNIT[" + unit + "]]";
}

const std::string survey_foot = "\"US survey foot\",0.304800609601219";

}  // namespace

TEST_CASE("a .prj file beside a grid gives its units")
{
    const TempFolder folder;
    const std::filesystem::path file = folder.write("a.asc", grid_head + "1 2 3\n4 5 6\n");
    const std::string name = GENERATE("a.prj", "a.PRJ");
    constexpr double foot = 1200.0 / 3937;
    folder.write(name, prj(survey_foot));
    const Scene feet = load_scene(file);
    CHECK(feet.bounds().max.x() == Approx(5 * foot));
    CHECK(feet.bounds().max.z() == 6);
    check_origin(feet, 500007.5, 4000005, "Plan");
    CHECK(feet.origin->unit == Approx(foot));
    CHECK(has_notice(feet, "a.asc: x and y are in units of 0.30480060960121"));
    folder.write(name, prj("\"Meter\",1.0") + vertical_prj("1.0", survey_foot));
    const Scene high = load_scene(file);
    CHECK(high.bounds().max.x() == 5);
    CHECK(high.bounds().max.z() == Approx(6 * foot));
    CHECK(has_notice(high, "a.asc: heights are in units of 0.30480060960121"));
    folder.write(name, prj("\"Meter\",1.0") + vertical_prj("-1.0", "\"Meter\",1.0"));
    const Scene deep = load_scene(file);
    CHECK(deep.bounds().min.z() == -6);
    CHECK(has_notice(deep, "its values are depths (Plan + Ups"));
    folder.write(name, prj("\"Meter\",1.0"));
    CHECK(load_scene(file).notices.size() == 1);  // where it lies
}

TEST_CASE("a .prj file with degrees is refused, and one that cannot be understood gets a notice")
{
    const TempFolder folder;
    const std::filesystem::path file = folder.write("a.asc", grid_head + "1 2 3\n4 5 6\n");
    folder.write("a.prj", gcs_of_prj);
    CHECK_THROWS_WITH(
        load_scene(file),
        file.string() +
            ": has coordinates in degrees (geographic, WGS 84), needs metres; reproject it: gdalwarp -t_srs "
            "EPSG:CODE, where CODE is a projection in metres, such as that of the UTM zone");
    SceneOptions options{.heightmap = "cell: 3"};
    CHECK(load_scene(file, options).bounds().max.x() == 3);
    for (const std::string text : {"Projection UTM\nZone 33\nUnits METERS\n", "", "PROJCS[\"Plan\""}) {
        folder.write("a.prj", text);
        const Scene scene = load_scene(file);
        CHECK(scene.bounds().max.x() == 5);
        CHECK(has_notice(
            scene, "a.prj: is not a coordinate system (WKT) that PROJ can read; x, y and heights are taken as metres"));
    }
}

TEST_CASE("cells of a grid may be rectangles, and holes are -9999 or the value in the header")
{
    const TempFolder folder;
    const Scene scene = load_scene(
        folder.write("a.asc", "ncols 3\nnrows 2\nxllcorner 0\nyllcorner 0\ndx 2\ndy 4\n1 2 -9999\n4 5 6\n"));
    CHECK(scene.bounds().max.x() == 2);
    CHECK(scene.bounds().max.y() == 2);
    CHECK(scene.triangles.size() == 3);
    CHECK(load_scene(folder.write("a.asc", grid_head + "NODATA_value 0\n0 2 3\n4 5 6\n")).triangles.size() ==
          2);  // the diagonal runs through this corner
    CHECK(load_scene(folder.write("a.asc", grid_head + "NODATA_value 0\n1 2 nan\n4 5 6\n")).triangles.size() == 3);
    CHECK(load_scene(folder.write("a.asc", grid_head + "NODATA_value 0\n1 2 -9999\n4 5 6\n")).bounds().min.z() ==
          -9999);
}

TEST_CASE("invalid grids are refused with the line")
{
    const TempFolder folder;
    const std::string start = (folder / "a.asc").string() + ": ";
    const auto check_refused = [&](const std::string& text, const std::string& reason) {
        CHECK_THROWS_WITH(load_scene(folder.write("a.asc", text)), start + reason);
    };
    const std::string known =
        " is neither a number nor a key of an ESRI ASCII grid's header; known keys: ncols, nrows, xllcorner or "
        "xllcenter, "
        "yllcorner or "
        "yllcenter, cellsize or dx and dy, NODATA_value";
    check_refused("north: 5\n", "line 1: \"north:\"" + known);
    check_refused("ncols 3\nrows 2\n", "line 2: \"rows\"" + known);
    check_refused(grid_head + "1 2 3\n4 5,5 6\n", "line 7: \"5,5\" is not a number");
    check_refused(grid_head + "1 2 3\n4 5 6 7\n",
                  "line 7 has 4 values, needs 3 (ncols): it has more than 6 values, needs 6 (3 x 2)");
    check_refused(grid_head + "1 2\n4 5 6\n", "line 6 has 2 values, needs 3 (ncols): it has 5 values, needs 6 (3 x 2)");
    check_refused(grid_head + "1 2 3\n", "it has 3 values, needs 6 (3 x 2)");
    check_refused(grid_head, "it has 0 values, needs 6 (3 x 2)");
    check_refused(grid_head + "1 2 3\n4 inf 6\n",
                  "row 1, column 1 is infinite, needs a finite height or NaN (no ground)");
    check_refused("ncols 3\nncols 3\n", "line 2: ncols is given twice");
    check_refused("ncols 3\nnrows x\n", "line 2: nrows is \"x\", needs a finite number");
    check_refused("ncols 3\nnrows", "line 2: nrows is the file's end, needs a finite number");
    check_refused("ncols 2.5\nnrows 2\n1", "ncols is 2.5, needs a whole number of 1 or more");
    check_refused("ncols 3\n1 2 3\n", "has no nrows in its header");
    check_refused("ncols 1000000\nnrows 1000000\nxllcorner 0\nyllcorner 0\ncellsize 1\n1",
                  "has 1000000 x 1000000 cells, needs at most 67108864; make it coarser with gdalwarp -tr, or extract "
                  "a part with gdal_translate -projwin");
    check_refused("ncols 3\nnrows 2\nxllcorner 0\nxllcenter 0\nyllcorner 0\ncellsize 1\n1",
                  "has xllcorner and xllcenter, needs one of them");
    check_refused("ncols 3\nnrows 2\nxllcorner 0\ncellsize 1\n1",
                  "has neither yllcorner nor yllcenter in its header, needs one of them");
    check_refused("ncols 3\nnrows 2\nxllcorner 0\nyllcorner 0\n1", "has no cellsize in its header");
    check_refused("ncols 3\nnrows 2\nxllcorner 0\nyllcorner 0\ndx 1\n1",
                  "has only one of dx and dy in its header, needs both, or cellsize");
    check_refused("ncols 3\nnrows 2\nxllcorner 0\nyllcorner 0\ncellsize 0\n1", "cellsize is 0, needs > 0");
    CHECK_THROWS_WITH(
        load_scene(folder.write("a.asc", "ncols 2\nnrows 2\nxllcorner 8\nyllcorner -46\ncellsize 0.000277\n1 2 3 4\n")),
        Contains("which look like degrees") && Contains("EPSG:32732"));
}

TEST_CASE("images and raw numbers need options that describe them")
{
    const TempFolder folder;
    const auto load = [&](const std::string& name, const std::string& keys) {
        SceneOptions options{.heightmap = keys};
        return load_scene(folder / name, options);
    };
    const auto raw = [&](const std::string& name, auto... values) {
        std::string bytes;
        (bytes.append(reinterpret_cast<const char*>(&values), sizeof values), ...);
        folder.write(name, bytes);
    };
    raw("a.raw", 1.5f, 2.5f, 3.5f, -4.5f, 5.5f, 6.5f);
    const Scene floats = load("a.raw", "raw: {type: float32, rows: 2, cols: 3}, size: [4, 2]");
    CHECK(floats.bounds().max == Vec3(2, 1, 6.5));
    CHECK(height(floats, -2, -1) == -4.5);
    using U16 = std::uint16_t;
    raw("a.r16", U16(0), U16(65535), U16(1), U16(258));
    CHECK(height(load("a.r16", "raw: {type: uint16, rows: 2, cols: 2}, cell: 3, z: [0, 6553.5]"), 1.5, -1.5) ==
          Approx(25.8));
    CHECK(height(load("a.r16", "raw: {type: int16, rows: 2, cols: 2}, cell: 3"), 1.5, 1.5) == -1);
    const std::string raw_file = (folder / "a.raw").string() + ": ", wrong = "load_scene: --heightmap: ";
    CHECK_THROWS_WITH(
        load_scene(folder / "a.raw"),
        raw_file + "has no header; give its layout with --heightmap 'raw: {type: float32, rows: R, cols: C}, cell: M'");
    CHECK_THROWS_WITH(load("a.raw", "raw: {type: float32, rows: 2, cols: 4}, cell: 1"),
                      raw_file + "has 24 bytes, needs 32 (4 x 2 pixels of 4 bytes)");
    CHECK_THROWS_WITH(load("a.raw", "raw: {type: float32, rows: 99999, cols: 99999}, cell: 1"),
                      raw_file + "has 99999 x 99999 pixels, needs at most 67108864");
    CHECK_THROWS_WITH(load("a.raw", "raw: {type: float16, rows: 2, cols: 3}"),
                      wrong + "raw.type is \"float16\", needs one of uint8, uint16, int16, float32, float64 (line 1)");
    CHECK_THROWS_WITH(load("a.raw", "raw: {type: uint8, rows: 2.5, cols: 3}"),
                      Contains("raw.rows is 2.5, needs a whole number from 1 to 67108864"));
    CHECK_THROWS_WITH(load("a.raw", "size: 3"), Contains("size is 3, needs a list"));
    CHECK_THROWS_WITH(load("a.raw", "sise: [1, 1]"), Contains("sise is not a known key"));
    CHECK_THROWS_WITH(load("a.raw", "size: [1, 1"), Contains("needs keys such as size: [513, 513], z: [0, 75]"));
}

TEST_CASE("the river's picture is read as the option --heightmap describes it", "[real]")
{
    const auto shared = shared_scenes();
    if (!shared) return;
    CHECK_THROWS_WITH(load_scene(*shared / "dem/river/relief.png"),
                      (*shared / "dem/river/relief.png").string() +
                          ": states neither its size nor its heights; give --heightmap 'size: [X, Y], z: [LOW, HIGH]' "
                          "(m from first to last pixel centre, and m of the values 0 and 65535)");
    const SceneOptions options{.heightmap = "size: [49, 36], z: [537.36, 543.81]"};
    CHECK(load_scene(*shared / "dem/river/relief.png", options).bounds().max == Vec3(24.5, 18, 543.81));
}

TEST_CASE("an elevation model gets no notice about millimetres or a wrong up axis")
{
    const TempFolder folder;
    const Scene steep = load_scene(folder.write("a.asc", grid_head + "0 0 0\n900 900 900\n"));
    CHECK(steep.notices.size() == 1);  // where it lies
    const Scene wide = load_scene(
        folder.write("a.asc", "ncols 3\nnrows 2\nxllcorner 0\nyllcorner 0\ncellsize 30000\n1 2 3\n4 5 6\n"));
    CHECK(wide.notices.size() == 1);
    CHECK(load_parts(folder, "  - {name: a, label: terrain, heightmap: {file: a.asc, cell: 0.001}}\n").notices.empty());
}

TEST_CASE("an elevation model as a scene takes labels, but no options for meshes")
{
    const TempFolder folder;
    const std::filesystem::path file = folder.write("Ground.asc", grid_head + "1 2 3\n4 5 6\n");
    SceneOptions options{.labels = {{"ground", Label::Obstacle}}};
    CHECK(load_scene(file, options).parts[0].label == Label::Obstacle);
    options.labels = {{"road", Label::Obstacle}};
    const Scene idle = load_scene(file, options);
    CHECK(idle.parts[0].label == Label::Terrain);
    CHECK(has_notice(idle, "label \"road\" matches no node, material or part; there are Ground"));
    options = {};
    options.scale = 2;
    CHECK_THROWS_WITH(load_scene(file, options), "load_scene: up and scale are for a mesh; " + file.string() +
                                                     " is an elevation model, in metres and z up");
    options = {};
    options.heightmap = "cell: 1";
    CHECK_THROWS_WITH(load_parts(folder, "  - {name: b, sphere: 1}\n", options),
                      Contains("--heightmap is for an elevation model by itself"));
}

TEST_CASE("elevation models that are cut at any byte are read or refused")
{
    const TempFolder folder;
    const std::string tiff = bytes_of(
        write(folder, {.ascii = "plan|", .no_data = "-9999", .metadata = "<Item role=\"scale\">1</Item>"}));
    const std::string grid = grid_head + "NODATA_value -9999\n1 2 3\n4 5 6\n";
    const auto [name, bytes] = GENERATE_COPY(std::pair{"a.tif", tiff}, std::pair{"a.asc", grid});
    std::size_t read = 0;
    for (std::size_t length = 0; length <= bytes.size(); ++length) {
        try {
            load_scene(folder.write(name, bytes.substr(0, length)));
            ++read;
        } catch (const FileError&) {
        }
    }
    CHECK(read >= 1);
    for (std::size_t at = 0; at < bytes.size(); ++at) {  // and with one wrong byte
        std::string changed = bytes;
        changed[at] = char(changed[at] ^ 0x15);
        try {
            load_scene(folder.write(name, changed));
        } catch (const FileError&) {
        }
    }
}

TEST_CASE("the grid of the river is the terrain of its scene", "[real]")
{
    const auto shared = shared_scenes();
    if (!shared) return;
    const Scene scene = load_scene(*shared / "dem/river/scene.yaml"),
                grid = load_scene(*shared / "dem/river/DEM-kootenai_37x50_1x1.asc");
    check_origin(grid, 556465, 5394950.5, "");
    const Geometry a(scene), b(grid);
    double largest = 0;
    for (double y = -18; y <= 18; y += 0.375)
        for (double x = -24.5; x <= 24.5; x += 0.21875) {
            const Column wanted = column_at(a, x, y), got = column_at(b, x, y);
            REQUIRE((wanted.layers.size() == 1 && got.layers.size() == 1));
            largest = std::max(largest, std::abs(wanted.layers[0] - got.layers[0]));
        }
    CHECK(largest < 1e-4);
}

TEST_CASE("the gully has terrain exactly where its grid has heights", "[real]")
{
    const auto shared = shared_scenes();
    if (!shared) return;
    const std::filesystem::path file = *shared / "dem/gully/west_bijou_gully.asc";
    const Geometry geometry(load_scene(file));
    std::istringstream text(bytes_of(file));
    std::string word;
    for (int i = 0; i < 12; ++i) text >> word;
    constexpr int rows = 89, cols = 43;
    Doubles z(rows * cols);
    for (double& value : z) REQUIRE(text >> value);
    CHECK(std::count(z.begin(), z.end(), 0.0) == 2739);
    const auto at = [&](int row, int col) { return z[std::size_t(row) * cols + std::size_t(col)]; };
    for (int row = 0; row + 1 < rows; ++row)
        for (int col = 0; col + 1 < cols; ++col) {
            // The middles of the two triangles, below and above the diagonal from the upper left corner.
            const double x = (col - 21) * 3.0, y = (44 - row) * 3.0;
            const auto check_triangle = [&](double u, double v, double a, double b, double c) {
                const Column column = column_at(geometry, x + 3 * u, y - 3 * v);
                const bool whole = a != 0 && b != 0 && c != 0;
                REQUIRE(column.layers.size() == (whole ? 1 : 0));
                if (whole) REQUIRE(column.layers[0] == Approx((a + b + c) / 3).epsilon(1e-12));
            };
            check_triangle(1 / 3.0, 2 / 3.0, at(row, col), at(row + 1, col), at(row + 1, col + 1));
            check_triangle(2 / 3.0, 1 / 3.0, at(row, col), at(row, col + 1), at(row + 1, col + 1));
        }
}

TEST_CASE("the corners of the Moon model have the heights of its pixels, in its polar plane", "[real]")
{
    const auto shared = shared_scenes();
    if (!shared) return;
    const Scene moon = load_scene(*shared / "dem/moon_tif/dem_moon.tif");
    constexpr double cell = 2.4266098484848486, half = 16 * cell;
    check_origin(moon, -53750 + 16.5 * cell, -51050 - 16.5 * cell, "Moon2000_npole");
    CHECK(moon.bounds().max.x() == Approx(half).epsilon(1e-12));
    const Geometry geometry(moon);
    // Slightly inside, because the outermost points are on the edge.
    const auto check_height = [&](int row, int col, double wanted) {
        const double x = (col - 16) * cell, y = (16 - row) * cell;
        const Column column = column_at(geometry, std::clamp(x, -half + 1e-9, half - 1e-9),
                                        std::clamp(y, -half + 1e-9, half - 1e-9));
        REQUIRE(column.layers.size() == 1);
        CHECK(column.layers[0] == Approx(wanted).margin(1e-6));
    };
    // The heights that GDAL reads (rasterio 1.4).
    check_height(0, 0, -206.0089111328125);
    check_height(0, 32, -208.593994140625);
    check_height(32, 0, -205.8878936767578);
    check_height(32, 32, -208.63790893554688);
    check_height(5, 20, -207.89031982421875);
}

TEST_CASE("a map stores the survey position of its elevation model, and info prints it")
{
    const TempFolder folder;
    folder.write(
        "a.asc",
        "ncols 3\nnrows 2\nxllcorner 556440.25\nyllcorner 5394932.125\ncellsize 5\nNODATA_value 0\n1 2 3\n4 5 6\n");
    const ProgramRun run = run_program(folder, "bake a.asc -o map --resolution 0.5");
    CHECK(run.status == 0);
    CHECK_THAT(run.err,
               Contains("notice: a.asc: x 556447.75, y 5394937.125 is at 0, 0 of the scene; z is not shifted\n"));
    const Map map = read_map(folder / "map");
    REQUIRE(map.origin);
    CHECK(map.origin->x == 556447.75);
    CHECK(map.origin->y == 5394937.125);
    CHECK(map.origin->unit == 1);
    CHECK_THAT(run_program(folder, "info map").out, Contains("\n  0, 0 is x 556447.75, y 5394937.125\n"));
    CHECK_THAT(run_program(folder, "info map --json").out, Contains("\"y\": 5394937.125"));
    CHECK_THAT(run_program(folder, "info a.asc").out, Contains("\n  0, 0 is x 556447.75, y 5394937.125\n"));
    write(folder, {});
    CHECK(run_program(folder, "bake a.tif -o map --resolution 0.5").status == 0);
    CHECK(read_map(folder / "map").origin->crs == "EPSG:32611");
    folder.write("scene.yaml", "format: spawnfield-scene/1\nparts: [{name: floor, label: terrain, box: [8, 8, 1]}]\n");
    CHECK(run_program(folder, "bake scene.yaml -o map --resolution 0.5").status == 0);
    CHECK_FALSE(read_map(folder / "map").origin);
    CHECK(run_program(folder, "bake a.asc -o map --heightmap 'cell: 0'").status == 2);
    CHECK(run_program(folder, "info map --heightmap 'cell: 1'").status == 2);
    folder.write("b.asc", grid_head + "NODATA_value 0\n0 0 0\n0 0 0\n");
    CHECK(run_program(folder, "bake b.asc -o map2").status == 4);
    CHECK_FALSE(std::filesystem::exists(folder / "map2"));
}
