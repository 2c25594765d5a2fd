#include "drawing/island_marks.h"
#include "drawing/obstacle_mask.h"
#include "drawing/pair_marks.h"
#include "drawing/quantities.h"
#include "drawing/relief.h"
#include "drawing/spawn_marks.h"
#include "picture/drawing_module.h"

#include <spawnfield/error.h>
#include <spawnfield/heatmap.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

namespace spawnfield {
namespace {

// ---------------------------------------------------------------- colours and words

const Colour not_valid = rgb(not_valid_colour), beyond = rgb(0xffffff);

std::string name_of(Kind kind, const HeatmapOptions& options)
{
    if (kind == obstacle) return "obstacle";
    if (kind == some_headings) return "valid at some headings";
    if (kind == kind_of(Verdict::Valid) && options.headings > 1)
        return "valid at all " + std::to_string(options.headings) + " headings";
    std::string name = to_string(static_cast<Verdict>(kind));
    std::replace(name.begin(), name.end(), '_', ' ');
    return name;
}

std::string counted(std::uint64_t count, const std::string& noun)
{
    return with_commas(count) + ' ' + noun + (count == 1 ? "" : "s");
}

/// Returns a count with its share of the total: "1,234   5.6 %".
std::string count_and_share(std::uint64_t count, std::uint64_t total)
{
    std::string text = with_commas(count);
    if (count == 0) return text;
    const double percent = 100 * static_cast<double>(count) / static_cast<double>(total);
    return text + "   " + (percent < 0.05 ? "< 0.1" : fixed(percent, 1)) + " %";
}

void check_size(const char* what, std::size_t size, std::size_t wanted, const char* limit)
{
    if (size != 0 && size != wanted)
        throw ArgumentError("write_heatmap", std::string("size of ") + what, static_cast<double>(size), limit);
}

void check_islands(const RasterResult& raster, const HeatmapOptions& options)
{
    if (options.islands.size() != raster.poses.size())
        throw ArgumentError("write_heatmap", "size of islands", double(options.islands.size()),
                            "as many as the raster's poses for this quantity");
    for (const std::int32_t island : options.islands)
        if (island >= std::int32_t(options.island_areas.size()))
            throw ArgumentError("write_heatmap", "islands", island,
                                "less than the number of island_areas, " + std::to_string(options.island_areas.size()));
}

void check_kinds(const HeatmapOptions& options)
{
    if (options.kinds.empty()) return;
    if (options.spawn_kinds.size() != options.spawns.size())
        throw ArgumentError("write_heatmap", "size of spawn_kinds", double(options.spawn_kinds.size()),
                            "as many as spawns");
    for (const std::size_t kind : options.spawn_kinds)
        if (kind >= options.kinds.size())
            throw ArgumentError("write_heatmap", "spawn_kinds", double(kind),
                                "less than the number of kinds, " + std::to_string(options.kinds.size()));
    if (!options.spawn_verdicts.empty())
        throw ArgumentError("write_heatmap",
                            "kinds and spawn_verdicts are both given, but spawns have one colour; leave one out");
}

void check(const RasterResult& raster, const HeatmapOptions& options)
{
    const RasterGrid& grid = raster.grid;
    if (options.pixels < 200 || options.pixels > 16000)
        throw ArgumentError("write_heatmap", "pixels", options.pixels, "200 .. 16000");
    if (!(grid.step > 0) || !std::isfinite(grid.step))
        throw ArgumentError("write_heatmap", "raster.grid.step", grid.step, "> 0 m");
    if (grid.cols < 1) throw ArgumentError("write_heatmap", "raster.grid.cols", grid.cols, ">= 1");
    if (grid.rows < 1) throw ArgumentError("write_heatmap", "raster.grid.rows", grid.rows, ">= 1");
    if (options.headings < 1 || options.headings > 255)
        throw ArgumentError("write_heatmap", "headings", options.headings, "1 .. 255");
    check_size("spawn_verdicts", options.spawn_verdicts.size(), options.spawns.size(), "as many as spawns, or none");
    check_size("spawn_names", options.spawn_names.size(), options.spawns.size(), "as many as spawns, or none");
    check_size("start_names", options.start_names.size(), options.starts.size(), "as many as starts, or none");
    check_size("goal_names", options.goal_names.size(), options.goals.size(), "as many as goals, or none");
    check_kinds(options);
    check_size("valid_headings", options.valid_headings.size(), raster.poses.size(),
               "as many as the raster's poses, or none");
    if (is_of_rest(options.quantity) && raster.rests.size() != raster.poses.size())
        throw ArgumentError("write_heatmap", "size of raster.rests", double(raster.rests.size()),
                            "as many as its poses for this quantity: a raster of settled poses at one yaw");
    if (is_measured(options.quantity) && options.values.size() != raster.poses.size())
        throw ArgumentError("write_heatmap", "size of values", double(options.values.size()),
                            "as many as the raster's poses for this quantity");
    if (options.quantity == HeatmapQuantity::Island) check_islands(raster, options);
}

// ---------------------------------------------------------------- obstacles

/// Returns a frame of cells over the view. A cell is as large as a pixel, or larger if there would be too many.
GridFrame fine_frame(const View& view, cv::Size pixels)
{
    constexpr double most = 2000;
    const double cell = std::max(view.width / pixels.width, std::max(view.width, view.height) / most);
    return {view.x0, view.y0, cell, static_cast<int>(std::ceil(view.height / cell)),
            static_cast<int>(std::ceil(view.width / cell))};
}

ObstacleSearch obstacle_search(const ShownPoses& shown, const RasterResult& raster, const HeatmapOptions& options)
{
    const RasterGrid& grid = raster.grid;
    const View view = view_of(grid);
    const double above_layer = raster.dims == 2 ? raster.offset
                                                : 0;  // a pose of a 3D raster is taken at its own height
    ObstacleSearch search;
    if (options.robot) search.robot = {options.robot->bounds().min.z(), options.robot->bounds().max.z()};
    search.robot.low += above_layer;
    search.robot.high += above_layer;
    search.reach = raster.dims == 2 ? 2 * grid.step : 0;
    search.without_layer = raster.dims == 2 && raster.area.is_everywhere();
    search.threads = options.threads;
    search.layer_near = [=, &shown, &raster](double x, double y) -> std::optional<double> {
        const int col = cell_index((x - view.x0) / grid.step, grid.cols),
                  from_below = cell_index((y - view.y0) / grid.step, grid.rows);
        const RasterPose* const pose = col < 0 || from_below < 0 ? nullptr : shown.at(grid.rows - 1 - from_below, col);
        return pose ? std::optional(layer_height(raster, *pose)) : std::nullopt;
    };
    return search;
}

/// Returns the title of a quantity's scale, with its unit.
const char* scale_title(HeatmapQuantity quantity)
{
    switch (quantity) {
    case HeatmapQuantity::Height: return "height of the pose, m";
    case HeatmapQuantity::Clearance: return "clearance, m";
    case HeatmapQuantity::HeadRoom: return "head room, m";
    case HeatmapQuantity::Roughness: return "roughness, m";
    case HeatmapQuantity::View: return "view, share of directions";
    case HeatmapQuantity::Room: return "room to manoeuvre, m2";
    case HeatmapQuantity::Tilt: return "tilt, degrees";
    case HeatmapQuantity::Roll: return "roll (right side down), degrees";
    case HeatmapQuantity::Pitch: return "pitch (nose down), degrees";
    case HeatmapQuantity::Margin: return "stability margin, m";
    case HeatmapQuantity::Belly: return "belly clearance, m";
    default: return "slope, degrees";
    }
}

/// Returns the scale of a quantity. Heights, rolls and pitches begin at the lowest value, the others at 0; all end at
/// the largest value, but angles not below 1 degree: on level floors, differences of less mean nothing.
ColourScale scale_for(const cv::Mat_<float>& values, HeatmapQuantity quantity)
{
    const bool from_zero = quantity != HeatmapQuantity::Height && quantity != HeatmapQuantity::Roll &&
                           quantity != HeatmapQuantity::Pitch;
    double low = std::numeric_limits<double>::infinity(), high = -low;
    for (const float value : values)
        if (std::isfinite(value)) {
            low = std::min<double>(low, value);
            high = std::max<double>(high, value);
        }
    if (from_zero || low > high) low = 0;
    if (high < low) high = 1;
    const bool is_angle = quantity == HeatmapQuantity::Tilt || quantity == HeatmapQuantity::Slope;
    if (from_zero && high == 0) high = 1;
    if (is_angle) high = std::max(high, 1.0);
    return scale_between(scale_title(quantity), low, high, viridis());
}

// ---------------------------------------------------------------- legend

using KindCounts = std::array<std::uint64_t, kind_count>;

KindCounts counts_of(const Kinds& kinds)
{
    KindCounts counts{};
    for (const Kind kind : kinds) ++counts[kind];
    return counts;
}

/// Returns the number of columns that have a verdict. Shares are relative to this number.
std::uint64_t answered(const KindCounts& counts)
{
    return std::accumulate(counts.begin(), counts.end(), std::uint64_t{0}) - counts[no_pose];
}

std::string columns_heading(const RasterResult& raster, std::uint64_t columns)
{
    char step[32];
    std::snprintf(step, sizeof step, "%.3g", raster.grid.step);
    return counted(columns, "column") + (columns > 1 ? std::string(", ") + step + " m apart" : "");
}

/// Adds the legend entry for columns without a pose, if there are any.
void append_no_pose(const RasterResult& raster, const KindCounts& counts, Legend& legend)
{
    if (counts[no_pose] == 0) return;
    const bool lower_layer = !raster.poses.empty() &&
                             std::all_of(raster.poses.begin(), raster.poses.end(),
                                         [](const RasterPose& pose) { return pose.layer > 0; });
    const std::string name = !raster.area.is_everywhere() ? "off the region, or no terrain"
                             : raster.dims == 3           ? "no pose"
                             : lower_layer                ? "no such layer"
                             : raster.z.is_unlimited()    ? "no terrain"
                                                          : "no terrain at these heights";
    legend.entries.push_back({colour_of(no_pose), name, counted(counts[no_pose], "column")});
}

/// Returns a legend of the kinds that occur or are usual, with the number of columns of each kind.
Legend verdict_legend(const RasterResult& raster, const Kinds& kinds, const HeatmapOptions& options)
{
    constexpr std::array order{kind_of(Verdict::Valid),      some_headings,
                               kind_of(Verdict::Steep),      kind_of(Verdict::Unstable),
                               kind_of(Verdict::Obstructed), kind_of(Verdict::Unreachable),
                               kind_of(Verdict::Collision),  obstacle,
                               kind_of(Verdict::Submerged),  kind_of(Verdict::OffTerrain),
                               kind_of(Verdict::Aerial),     kind_of(Verdict::Outside)};
    constexpr std::array always{kind_of(Verdict::Valid), kind_of(Verdict::Collision), kind_of(Verdict::Submerged),
                                kind_of(Verdict::OffTerrain)};
    const KindCounts counts = counts_of(kinds);
    const std::uint64_t columns = answered(counts);
    Legend legend;
    legend.heading = columns_heading(raster, columns);
    for (const Kind kind : order) {
        const bool possible = std::find(always.begin(), always.end(), kind) != always.end() ||
                              (kind == some_headings && options.headings > 1) ||
                              (kind == kind_of(Verdict::Aerial) && raster.dims == 3);
        if (counts[kind] > 0 || possible)
            legend.entries.push_back({colour_of(kind), name_of(kind, options), count_and_share(counts[kind], columns)});
    }
    append_no_pose(raster, counts, legend);
    return legend;
}

/// Adds the legend entries for columns that are not valid.
void append_others(const RasterResult& raster, const KindCounts& counts, const HeatmapOptions& options, Legend& legend)
{
    const std::uint64_t columns = answered(counts),
                        others = columns - counts[kind_of(Verdict::Valid)] - counts[obstacle];
    legend.entries.push_back({not_valid, options.headings > 1 ? "not valid at all headings" : "not valid",
                              count_and_share(others, columns)});
    if (counts[obstacle] > 0)
        legend.entries.push_back({colour_of(obstacle), "obstacle", count_and_share(counts[obstacle], columns)});
    append_no_pose(raster, counts, legend);
}

Legend island_legend(const RasterResult& raster, const Kinds& kinds, const ShownIslands& islands,
                     const HeatmapOptions& options)
{
    const KindCounts counts = counts_of(kinds);
    Legend legend{
        .heading = columns_heading(raster, answered(counts)), .scale = {}, .entries = island_entries(islands, options)};
    append_others(raster, counts, options, legend);
    return legend;
}

Legend quantity_legend(const RasterResult& raster, const Kinds& kinds, const ColourScale& scale,
                       const HeatmapOptions& options)
{
    const KindCounts counts = counts_of(kinds);
    const std::uint64_t columns = answered(counts);
    Legend legend;
    legend.heading = columns_heading(raster, columns);
    legend.scale = scale;
    legend.scale->detail = "valid   " + count_and_share(counts[kind_of(Verdict::Valid)], columns);
    append_others(raster, counts, options, legend);
    return legend;
}

// ---------------------------------------------------------------- plot

Image kind_colours(const Kinds& kinds)
{
    Image colours(kinds.size());
    std::transform(kinds.begin(), kinds.end(), colours.begin(), colour_of);
    return colours;
}

Image quantity_colours(const Kinds& kinds, const cv::Mat_<float>& values, const ColourScale& scale)
{
    Image colours(kinds.size());
    for (int row = 0; row < kinds.rows; ++row)
        for (int col = 0; col < kinds.cols; ++col) {
            const float value = values(row, col);
            const Kind kind = kinds(row, col);
            colours(row, col) = std::isfinite(value)                  ? scale.colour(value)
                                : kind == obstacle || kind == no_pose ? colour_of(kind)
                                                                      : not_valid;
        }
    return colours;
}

/// Draws each pixel in the colour of its nearest column.
Image draw_columns(const Image& colours, const View& columns, const View& view, cv::Size pixels)
{
    Image plot(pixels, beyond);
    std::vector<int> across;
    for (int col = 0; col < pixels.width; ++col) {
        const double x = view.x0 + (col + 0.5) / pixels.width * view.width;
        across.push_back(cell_index((x - columns.x0) / columns.width * colours.cols, colours.cols));
    }
    for (int row = 0; row < pixels.height; ++row) {
        const double y = view.y0 + view.height - (row + 0.5) / pixels.height * view.height;
        const int from = cell_index((columns.y0 + columns.height - y) / columns.height * colours.rows, colours.rows);
        if (from < 0) continue;
        for (int col = 0; col < pixels.width; ++col)
            if (const int column = across[static_cast<std::size_t>(col)]; column >= 0)
                plot(row, col) = colours(from, column);
    }
    return plot;
}

void shade(Image& plot, const cv::Mat_<float>& light, float depth)
{
    for (int row = 0; row < plot.rows; ++row)
        for (int col = 0; col < plot.cols; ++col)
            if (plot(row, col) != beyond) plot(row, col) = shaded(plot(row, col), light(row, col), depth);
}

/// Draws obstacles over the shaded plot, because the relief shows the ground below them. The white room around thin
/// views remains white.
void draw_obstacles(Image& plot, const cv::Mat_<std::uint8_t>& obstacles, const GridFrame& frame, const View& columns,
                    const View& view)
{
    for (int row = 0; row < plot.rows; ++row) {
        const double y = view.y0 + view.height - (row + 0.5) / plot.rows * view.height;
        const int from_below = cell_index((y - frame.y0) / frame.cell, frame.rows);
        if (from_below < 0 || cell_index((y - columns.y0) / columns.height, 1) < 0) continue;
        for (int col = 0; col < plot.cols; ++col) {
            const double x = view.x0 + (col + 0.5) / plot.cols * view.width;
            const int cell = cell_index((x - frame.x0) / frame.cell, frame.cols);
            if (cell >= 0 && cell_index((x - columns.x0) / columns.width, 1) >= 0 &&
                obstacles(frame.rows - 1 - from_below, cell))
                plot(row, col) = colour_of(obstacle);
        }
    }
}

// ---------------------------------------------------------------- spawns

/// Converts places on the ground to places in the picture.
class PlotPlaces {
public:
    PlotPlaces(const View& view, const cv::Rect& plot) : view_(view), plot_(plot) {}

    cv::Point2d at(const Vec3& point) const
    {
        return {plot_.x + across(point) * plot_.width, plot_.y + down(point) * plot_.height};
    }
    bool sees(const Vec3& point) const
    {
        return across(point) >= 0 && across(point) <= 1 && down(point) >= 0 && down(point) <= 1;
    }

private:
    double across(const Vec3& point) const { return (point.x() - view_.x0) / view_.width; }
    double down(const Vec3& point) const { return (view_.y0 + view_.height - point.y()) / view_.height; }

    const View view_;
    const cv::Rect plot_;
};

/// Returns the indices of the spawns whose origin is in the view.
std::vector<std::size_t> visible_spawns(const std::vector<Spawn>& spawns, const PlotPlaces& places)
{
    std::vector<std::size_t> out;
    for (std::size_t i = 0; i < spawns.size(); ++i)
        if (places.sees(spawns[i].position)) out.push_back(i);
    return out;
}

Colour colour_of_kind(std::size_t kind) { return rgb(kind_palette[std::min(kind, kind_palette.size() - 1)]); }

/// Returns the kind of a spawn; 0 if all are of one kind.
std::size_t kind_of_spawn(const HeatmapOptions& options, std::size_t spawn)
{
    return options.kinds.empty() ? 0 : options.spawn_kinds[spawn];
}

Colour spawn_colour(const HeatmapOptions& options, std::size_t spawn)
{
    return options.spawn_verdicts.empty() ? colour_of_kind(kind_of_spawn(options, spawn))
                                          : colour_of(kind_of(options.spawn_verdicts[spawn]));
}

/// Returns how the spawns of each kind are drawn.
std::vector<SpawnLook> spawn_looks(const HeatmapOptions& options, const Layout& layout, double scale, std::size_t count)
{
    std::vector<SpawnLook> out;
    for (const HeatmapKind& kind : options.kinds) out.push_back(spawn_look(kind.robot, layout, scale, count));
    if (out.empty()) out.push_back(spawn_look(options.robot, layout, scale, count));
    return out;
}

std::string count_in_view(std::size_t seen, std::size_t all, const std::string& noun)
{
    return seen == all ? counted(all, noun) : with_commas(seen) + " of " + counted(all, noun) + " in view";
}

/// Returns the legend's symbols of the spawns, by kind or by verdict. Before the layout is known, there are no looks;
/// then the symbols cannot be drawn.
std::vector<LegendSymbol> spawn_symbols(const HeatmapOptions& options, const std::vector<std::size_t>& visible,
                                        const std::vector<SpawnLook>& looks)
{
    std::vector<LegendSymbol> out;
    if (options.spawns.empty()) return out;
    const auto add = [&](const std::string& name, std::size_t kind, Colour colour) {
        const SpawnLook look = looks.empty() ? SpawnLook{} : looks[kind];
        out.push_back({name, [=](Figure& into, cv::Point2d centre) { draw_spawn_symbol(into, look, centre, colour); }});
    };
    const std::string text = count_in_view(visible.size(), options.spawns.size(), "spawn");
    if (options.kinds.empty() && options.spawn_verdicts.empty()) {
        add(text, 0, colour_of_kind(0));
        return out;
    }
    out.push_back({text});
    for (std::size_t kind = 0; kind < options.kinds.size(); ++kind) {
        const auto count = std::ranges::count(visible, kind, [&](std::size_t i) { return options.spawn_kinds[i]; });
        if (count > 0)
            add(with_commas(std::uint64_t(count)) + ' ' + options.kinds[kind].name, kind, colour_of_kind(kind));
    }
    if (options.spawn_verdicts.empty()) return out;
    for (auto verdict = all_verdicts.rbegin(); verdict != all_verdicts.rend(); ++verdict) {
        const auto count = std::ranges::count(visible, *verdict,
                                              [&](std::size_t i) { return options.spawn_verdicts[i]; });
        if (count > 0)
            add(with_commas(std::uint64_t(count)) + ' ' + name_of(kind_of(*verdict), {}), 0,
                colour_of(kind_of(*verdict)));
    }
    return out;
}

/// Draws the spawns, and returns their marks for write_names().
std::vector<NamedMark> draw_spawns(Figure& figure, const HeatmapOptions& options,
                                   const std::vector<std::size_t>& visible, const PlotPlaces& places,
                                   const std::vector<SpawnLook>& looks)
{
    std::vector<NamedMark> out;
    for (const std::size_t i : visible) {
        const SpawnLook& look = looks[kind_of_spawn(options, i)];
        const cv::Point2d place = places.at(options.spawns[i].position);
        draw_spawn(figure, look, place, options.spawns[i].yaw, spawn_colour(options, i));
        if (!options.spawn_names.empty()) out.push_back({place, radius_of(look), options.spawn_names[i]});
    }
    return out;
}

// ---------------------------------------------------------------- the whole picture

bool has_names(const HeatmapOptions& options)
{
    return !options.spawn_names.empty() || !options.start_names.empty() || !options.goal_names.empty();
}

/// Writes the names of the marks. Updates the last symbol of the legend, which is reserved for names without room.
void write_all_names(Figure& figure, const std::vector<NamedMark>& marks, const Layout& layout, Legend& legend)
{
    const std::size_t written = write_names(figure, layout.unit, marks, layout.plot);
    if (written < marks.size())
        legend.symbols.back().name = with_commas(written) + " of " + counted(marks.size(), "name") + " shown: no room";
    else
        legend.symbols.pop_back();
}

/// Returns the legend's symbols of spawns and pairs.
std::vector<LegendSymbol> all_symbols(const HeatmapOptions& options, const View& view,
                                      const std::vector<std::size_t>& visible, const std::vector<SpawnLook>& looks,
                                      double unit)
{
    std::vector<LegendSymbol> out = spawn_symbols(options, visible, looks);
    const PlotPlaces whole(view, {0, 0, 1, 1});
    const auto seen = [&](const std::vector<Vec3>& points) {
        return std::size_t(std::ranges::count_if(points, [&](const Vec3& point) { return whole.sees(point); }));
    };
    const auto add = [&](PairMark mark, std::size_t in_view, std::size_t all, const std::string& noun) {
        if (all == 0) return;
        out.push_back({count_in_view(in_view, all, noun),
                       [=](Figure& into, cv::Point2d centre) { draw_pair_symbol(into, mark, centre, unit); }});
    };
    add(PairMark::Start, seen(options.starts), options.starts.size(), "start");
    add(PairMark::Goal, seen(options.goals), options.goals.size(), "goal");
    add(PairMark::Path, options.paths.size(), options.paths.size(), "path");
    if (has_names(options)) out.push_back({"names: no room for all of them"});  // reserves a line in the layout
    return out;
}

/// Draws paths, starts and goals, and returns the marks of these for write_names().
std::vector<NamedMark> draw_pairs(Figure& figure, const HeatmapOptions& options, const PlotPlaces& places,
                                  const Layout& layout)
{
    const double radius = pair_mark_radius(layout, options.starts.size() + options.goals.size());
    for (const std::vector<Vec3>& path : options.paths) {
        std::vector<cv::Point2d> line;
        for (const Vec3& point : path) line.push_back(places.at(point));
        draw_path(figure, line, layout.unit);
    }
    std::vector<NamedMark> out;
    const auto draw = [&](PairMark mark, const std::vector<Vec3>& points, const std::vector<std::string>& names) {
        for (std::size_t i = 0; i < points.size(); ++i) {
            if (!places.sees(points[i])) continue;
            const cv::Point2d place = places.at(points[i]);
            draw_pair_mark(figure, mark, place, radius, layout.unit);
            if (!names.empty()) out.push_back({place, radius, names[i]});
        }
    };
    draw(PairMark::Goal, options.goals, options.goal_names);
    draw(PairMark::Start, options.starts, options.start_names);
    return out;
}

}  // namespace

void drawing_module::write_heatmap(const Map& map, const TerrainMap& terrain, const RasterResult& raster,
                                   const HeatmapOptions& options, const std::filesystem::path& file)
{
    check(raster, options);
    const PictureFormat format = options.format ? *options.format : picture_format(file);
    const ShownPoses shown = shown_poses(raster, options);
    const ObstacleSearch search = obstacle_search(shown, raster, options);
    Kinds kinds = column_kinds(shown, raster, options);
    mark_obstacles(kinds, obstacle_mask(map.geometry, frame_of(raster.grid), search));
    const View columns = view_of(raster.grid);
    PictureFrame frame{
        with_room(columns), options.pixels, options.title.empty() ? map.name : options.title, {}, options.caption};

    Image colours;
    ShownIslands islands;
    if (options.quantity == HeatmapQuantity::Verdict) {
        colours = kind_colours(kinds);
        frame.legend = verdict_legend(raster, kinds, options);
    } else if (options.quantity == HeatmapQuantity::Island) {
        islands = shown_islands(shown, raster, options);
        colours = island_colours(islands, kinds);
        frame.legend = island_legend(raster, kinds, islands, options);
    } else {
        const cv::Mat_<float> values = quantity_values(shown, raster, terrain, options);
        const ColourScale scale = scale_for(values, options.quantity);
        colours = quantity_colours(kinds, values, scale);
        frame.legend = quantity_legend(raster, kinds, scale, options);
    }
    const std::vector<std::size_t> visible = visible_spawns(options.spawns, {frame.view, {0, 0, 1, 1}});
    frame.legend.symbols = all_symbols(options, frame.view, visible, {}, 1);
    const Layout layout = lay_out(frame);
    Image plot = draw_columns(colours, columns, frame.view, layout.plot.size());
    const float depth = options.quantity == HeatmapQuantity::Verdict
                            ? 1
                            : 0.5f;  // half: users read values from the lightness
    shade(plot, relief(terrain.frame, highest_within(terrain, raster.z), frame.view, plot.size()), depth);
    const GridFrame fine = fine_frame(frame.view, plot.size());
    draw_obstacles(plot, obstacle_mask(map.geometry, fine, search), fine, columns, frame.view);
    const PlotPlaces places(frame.view, layout.plot);
    const auto looks = spawn_looks(options, layout, plot.cols / frame.view.width, visible.size());
    frame.legend.symbols = all_symbols(options, frame.view, visible, looks, layout.unit);

    Figure figure{layout.size, {}};
    draw_image(figure, layout.plot.tl(), plot);
    if (!islands.numbers.empty()) write_island_numbers(figure, islands, columns, frame.view, layout);
    clip(figure, layout.plot);
    std::vector<NamedMark> marks = draw_pairs(figure, options, places, layout);
    for (NamedMark& mark : draw_spawns(figure, options, visible, places, looks)) marks.push_back(std::move(mark));
    clip(figure, {});
    if (has_names(options)) write_all_names(figure, marks, layout, frame.legend);
    draw_surroundings(figure, frame, layout);
    write_figure(figure, format, file);
}

}  // namespace spawnfield
