#pragma once

#include <spawnfield/export.h>
#include <spawnfield/heading_rule.h>
#include <spawnfield/judge.h>
#include <spawnfield/place_quantities.h>
#include <spawnfield/place_rules.h>
#include <spawnfield/region.h>

#include <cmath>

namespace spawnfield {

/// Selects layers of a column. The index counts from the top, beginning with 0.
struct LayerChoice {
    enum class Kind { All, Top, Bottom, Index } kind = Kind::All;
    int index = 0;

    bool includes(int layer, int layer_count) const
    {
        switch (kind) {
        case Kind::Top: return layer == 0;
        case Kind::Bottom: return layer == layer_count - 1;
        case Kind::Index: return layer == index;
        case Kind::All: break;
        }
        return true;
    }
};

/// Returns whether the robot can get to a valid settled pose (not raised), for example from on_islands(). Queries call
/// it only for such poses, from several threads at the same time. It must always give the same answer for a pose.
using ReachFilter = std::function<bool(const SettledPose&)>;

struct RasterOptions {
    int dims = 2;        ///< 2: a pose for each column and layer; 3: a pose for each column and height
    double step = 1.0;   ///< m between columns, > 0
    double step_z = 0;   ///< m between heights, > 0; 0: the same as step
    Bounds bounds = {};  ///< empty: those of the map; 2D rasters do not use z
    ZRange z = {};       ///< 2D: layers beyond these heights, m, or beyond the map's z limits are not ground
    /// Columns and layers outside this area are left out: they have no pose and are not counted. For 3D rasters, the
    /// regions must not have z limits.
    Area area = {};
    /// Settled, only for 2D: the robot is let down onto each layer. Poses are settled poses, raised by
    /// StandLimits::lift. Needs JudgeOptions::obstacles Geometry.
    Stance stance = Stance::Level;
    /// Height of the origin of a level robot above its layer, m, for 2D rasters and snap; with snap 0 .. max_height. No
    /// value: auto_offset(). Must not be given for settled robots.
    std::optional<double> offset = {};
    double yaw = 0;  ///< rad
    /// Only for settled robots: chooses the yaw of each pose, in place of `yaw`. For All and Any, it is that of the
    /// first heading at which the pose is valid.
    std::optional<HeadingRule> heading = {};
    /// Only for settled robots: valid poses that it refuses are `unreachable`. With several headings, a heading at
    /// which it refuses the pose is not valid.
    ReachFilter is_reachable = {};
    /// The layers that count. For 3D rasters, the layer is the pose's ground: unless all layers are chosen, aerial
    /// poses and poses over other ground are left out.
    LayerChoice layers = {};
    /// False (3D only): every pose is checked for collisions, and for nothing else; max_slope is not used.
    bool height_check = true;
    /// For 3D with height check. Each chosen layer within the z of the bounds gets its pose of the 2D raster. This pose
    /// replaces the lowest step at or above the layer (RasterGrid::step_above), if there is one, and a step at the
    /// pose's own height (to 1e-9 m). So no terrain between two steps is missed.
    bool snap = false;
    int threads = 0;  ///< 0: all cores; results are the same for any number
    Progress progress = {};
};

/// Columns are at x0 + i * step, y0 + (first_row + j) * step, heights at z0 + k * step_z.
struct RasterGrid {
    double x0 = 0, y0 = 0, z0 = 0, step = 1, step_z = 1;
    int cols = 0, rows = 0, heights = 0;
    int first_row = 0;  ///< of the part of a raster; 0 for a whole one

    double x_of(int i) const { return x0 + i * step; }
    double y_of(int j) const { return y0 + (first_row + j) * step; }
    double z_of(int k) const { return z0 + k * step_z; }
    /// Returns the number of the lowest step at or above this height, to touch_tolerance; `heights` if there is none.
    SPAWNFIELD_API int step_above(double height) const;
};

struct RasterPose {
    double x, y, z;
    /// Number of the layer that is its ground (2D, snap: of the layer on which it was placed); 0 is the highest layer,
    /// -1: the ground is not a layer. Only layers that are ground for the query are counted (2D: see RasterOptions::z
    /// and the map's z limits).
    std::int32_t layer;
    Verdict verdict;
    bool snapped = false;  ///< 3D: the pose is on a layer and replaces a step
};

/// How the robot of a pose stands. The lengths and angles are those of SettledPose.
struct RasterRest {
    double layer_height = 0;     ///< of the layer onto which the robot was let down, m
    double roll = 0, pitch = 0;  ///< rad, as in URDF's rpy
    /// rad, m, rad, m. NaN: the robot has no room, or the place cannot be used.
    double tilt = std::numeric_limits<double>::quiet_NaN(), margin = tilt, tip_over = tilt, belly = tilt;

    double yaw = 0;  ///< rad
    /// With a HeadingRule of several headings: bit k is set if the pose is valid at heading k.
    std::uint64_t valid_headings = 0;
    /// m; with HeadingRule::Clearest, the clearance at `yaw` (at most 10 m), and with Along, the length of the way
    /// straight ahead. NaN: another rule, or no heading is valid.
    double free_length = std::numeric_limits<double>::quiet_NaN();

    bool has_pose() const { return !std::isnan(tilt); }
};

struct RasterResult {
    int dims = 2;
    RasterGrid grid;
    Area area = {};  ///< columns outside it were left out
    Stance stance = Stance::Level;
    double yaw = 0;                           ///< rad, of all poses, unless there is a rule
    std::optional<HeadingRule> heading = {};  ///< then the yaw of a pose is RasterRest::yaw
    /// Height of the poses above their layers, m. For settled poses: of a level robot on level ground, raised by the
    /// lift. Settled poses without RasterRest::has_pose are at this height, too.
    double offset = 0;
    ZRange z = {};  ///< 2D: only layers in this range are ground
    /// Row by row, y ascending; in a row, x ascending; in a column, from the top down (settled: from the highest layer
    /// down). Without the aerial poses of 3D rasters.
    std::vector<RasterPose> poses;
    std::vector<RasterRest> rests;  ///< one for each settled pose; empty for level poses and raster_at_headings()
    VerdictCounts counts;           ///< of all poses, including the aerial ones
    std::uint64_t exact_checks = 0;
};

/// Returns the verdict on every pose of a raster. Throws ArgumentError for options beyond their limits, for bounds with
/// min > max, and for more than 2^31 columns. Throws FileError for a damaged map.
SPAWNFIELD_API RasterResult raster(const Judge& judge, const RasterOptions& options);

/// The same for large rasters: calls take(part) for consecutive rows, so that the memory does not grow with the raster.
/// A part has about `poses` poses, at least a row. Its grid has its rows; put together, the poses of all parts are
/// those of raster(). Returns the result without poses.
SPAWNFIELD_API RasterResult raster_in_parts(const Judge& judge, const RasterOptions& options,
                                            const std::function<void(const RasterResult& part)>& take,
                                            std::int64_t poses = 1 << 20);

/// Calls visit for each pose of a raster, in their order. With `aerial`, also calls it for the aerial poses of a 3D
/// raster that are not in raster.poses, at their places in the order.
SPAWNFIELD_API void for_each_pose(const RasterResult& raster, bool aerial,
                                  const std::function<void(const RasterPose&)>& visit);

struct Spawn {
    Vec3 position = Vec3::Zero();
    double yaw = 0;              ///< rad
    double roll = 0, pitch = 0;  ///< rad, as in URDF's rpy
};

/// How the robot of a settled spawn stands.
struct SpawnRest {
    double tilt = 0, margin = 0;                                    ///< rad and m, as in SettledPose
    double free_length = std::numeric_limits<double>::quiet_NaN();  ///< as in RasterRest
};

inline constexpr double double_ground = 0.1;  ///< m between two layers that are likely the same ground twice

struct SpawnList {
    std::vector<Spawn> spawns;     ///< in the order in which they were found
    std::vector<SpawnRest> rests;  ///< one for each spawn of settled robots; empty for level ones
    Stance stance = Stance::Level;
    std::optional<HeadingRule> heading = {};  ///< that of the options
    VerdictCounts counts;                     ///< of the positions that were judged
    std::uint64_t draws = 0;                  ///< number of all draws
    /// Draws outside the options' area. search() of settled robots: or whose ground is outside it, or beyond the
    /// heights of the box.
    std::uint64_t off_area = 0;
    std::vector<PlaceColumn> columns = {};  ///< those of SampleOptions::measures
    /// Draws that would be spawns without SampleOptions::measures.prefer; `counts` is without them.
    std::uint64_t not_preferred = 0;
    std::uint64_t off_rules = 0;     ///< draws that do not comply with SampleOptions::place; `counts` is without them
    std::uint64_t near_avoided = 0;  ///< draws too near to a point of the options' `avoid`
    std::uint64_t too_close = 0;     ///< draws nearer than min_distance to an earlier one
    std::uint64_t exact_checks = 0;
    /// Only counted by sample(): judged positions on a layer that has another of the chosen layers at most
    /// double_ground above it, likely the same ground twice.
    std::uint64_t on_double_ground = 0;
    /// There are fewer than `count` spawns because the options' `stop` returned true. They are the first ones of the
    /// whole list; a stop loses fewer than 2,048 draws of settled robots that were judged, or 262,144 of level ones.
    bool is_stopped = false;
    /// Only set by sample(): there are fewer than `count` spawns, and it is proven that no other spawn fits. With place
    /// rules, this is proven only if no place can comply with them.
    bool is_full = false;
    /// Only set by sample(), if there are fewer than `count` spawns without that proof: the horizontal area, m2, in
    /// which a spawn may still fit. NaN: nothing is proven (settled robots without place rules; a stop).
    double undecided_area = 0;
};

/// Largest number of spawns. More do not fit into memory, and nobody needs more.
inline constexpr std::size_t max_spawns = 100000000;

/// Points from which spawns keep a distance, for example robots that have been placed already.
struct AvoidedPoints {
    std::string name = {};          ///< for the user: the file from which they come
    std::vector<Vec3> points = {};  ///< finite, m
    double distance = 0;  ///< m between a point and a spawn (in 3D), >= 0; a spawn at exactly this distance is allowed
};

struct SearchOptions {
    std::size_t count = 1;    ///< 1 .. max_spawns
    double min_distance = 0;  ///< m between positions, >= 0
    bool random_yaw = false;  ///< uniform in [-pi, pi); false: `yaw`
    double yaw = 0;           ///< rad
    std::uint64_t seed = 0;
    /// Settled: the robot is let down from each draw, onto the ground at or below it, and the position of the draw is
    /// that of the settled pose, raised by StandLimits::lift. Spawns are these poses. Needs JudgeOptions::obstacles
    /// Geometry.
    Stance stance = Stance::Level;
    std::optional<HeadingRule> heading = {};  ///< the same as SampleOptions::heading
    /// Box of the draws; empty: that of the map. Settled: ground beyond its heights does not count (to
    /// touch_tolerance).
    Bounds bounds = {};
    /// All spawns lie in this area, and draws are made within its bounds. Of settled robots, their ground does, too. A
    /// draw outside the area counts as a failure and is not judged (SpawnList::off_area).
    Area area = {};
    /// A draw that is too near to one of these points counts as a failure and is not judged (SpawnList::near_avoided).
    std::vector<AvoidedPoints> avoid = {};
    /// The search ends after this number of draws in a row without a spawn; >= 1.
    std::uint64_t max_failures = 100000;
    int threads = 0;  ///< 0: all cores; results are the same for any number
    Progress progress = {};
    StopRequest stop = {};  ///< see SpawnList::is_stopped
};

/// Returns spawns from a random search (Ropelato). Draws are uniform in a box. Each draw must keep min_distance to all
/// positions that were judged before; a settled robot that cannot be let down has the position of its draw. The search
/// ends after `count` valid draws, or after max_failures draws in a row without a valid one. Draws too near to an
/// avoided point are failures. Throws ArgumentError for options beyond their limits, FileError for a damaged map.
SPAWNFIELD_API SpawnList search(const Judge& judge, const SearchOptions& options);

struct SampleOptions {
    std::size_t count = 1;    ///< 1 .. max_spawns
    double min_distance = 0;  ///< m between positions, >= 0
    bool random_yaw = false;  ///< uniform in [-pi, pi); false: `yaw`
    double yaw = 0;           ///< rad
    std::uint64_t seed = 0;
    /// Settled: spawns are settled poses, raised by StandLimits::lift. Needs JudgeOptions::obstacles Geometry.
    Stance stance = Stance::Settled;
    /// Only for settled robots: chooses the yaw of each spawn, in place of `yaw` and `random_yaw`. For All and Any, it
    /// is a random one of the headings at which the pose is valid.
    std::optional<HeadingRule> heading = {};
    ReachFilter is_reachable = {};    ///< the same as RasterOptions::is_reachable
    std::string reachable_name = {};  ///< for the user: what is_reachable accepts; spawns_json() writes it
    /// Height of the origin of a level robot above its layer, m, at most max_height; no value: auto_offset(). Must not
    /// be given for settled robots.
    std::optional<double> offset = {};
    LayerChoice layers = {};
    ZRange z = {};                ///< layers beyond these heights, m, or beyond the map's z limits are not ground
    Bounds bounds = {};           ///< in x and y; empty: those of the map
    Area area = {};               ///< the same as SearchOptions::area
    PlaceRules place = {};        ///< all spawns comply with these rules
    PlaceMeasures measures = {};  ///< what is measured of spawns, and which places are preferred
    std::vector<AvoidedPoints> avoid = {};  ///< the same as SearchOptions::avoid
    int threads = 0;                        ///< 0: all cores; results are the same for any number
    Progress progress = {};
    StopRequest stop = {};  ///< see SpawnList::is_stopped
};

/// Returns valid poses that are distributed uniformly by horizontal area over the feasible region of all chosen layers.
/// Each pose is confirmed exactly. Poses are at least min_distance apart, and keep the distances of `avoid`.
///
/// When many draws fail, sampling continues in cells that cover the region. Cells that are proven to have no room for
/// another spawn are dropped; the proofs use the scene's geometry. The other cells are split, and draws are made only
/// in them, again uniformly by area. Sampling ends with fewer than `count` spawns if no cell is left (is_full), or if
/// the cells become too small (0.1 mm) or too many. Throws ArgumentError for options beyond their limits, FileError for
/// a damaged map. Sources: White, Cline, Egbert, Poisson disk point sets by hierarchical dart throwing, 2007; Ebeida et
/// al., A simple algorithm for maximal Poisson-disk sampling in high dimensions, 2012.
///
/// Settled poses have no such proofs yet: sampling ends after 5,000 draws in a row without a spawn. With place
/// rules, draws are made only in cells in which the rules can hold, and sampling ends after 100,000 such draws.
SPAWNFIELD_API SpawnList sample(const Judge& judge, const SampleOptions& options);

}  // namespace spawnfield
