#pragma once

#include <spawnfield/export.h>
#include <spawnfield/judge.h>
#include <spawnfield/region.h>

namespace spawnfield {

/// Which layers of a column count. The index counts from the top, 0 first.
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

struct RasterOptions {
    int dims = 2;        ///< 2: a pose per column and layer; 3: a pose per column and height
    double step = 1.0;   ///< m between columns, > 0
    double step_z = 0;   ///< m between heights, > 0; 0: as step
    Bounds bounds = {};  ///< empty: the map's; two-dimensional rasters do not use z
    ZRange z = {};       ///< 2D: layers beyond these heights, m, or beyond the map's z limits are no ground
    /// Columns and layers elsewhere are left out: they give no pose and count nowhere. 3D: of regions without z limits.
    Area area = {};
    /// m of the origin above its layer (2D, snap); with snap 0 .. max_height. Without a value: auto_offset().
    std::optional<double> offset = {};
    double yaw = 0;            ///< rad
    LayerChoice layers = {};   ///< 3D: of the ground; poses over other ground, and the aerial ones, are left out
    bool height_check = true;  ///< false (3D only): collisions alone, at every pose; max_slope is not used
    /// 3D with height check: each chosen layer within the bounds' z has its pose of the 2D raster, which replaces the
    /// lowest step at or above it (RasterGrid::step_above) if there is one, and a step at its very place (to 1e-9 m).
    /// So no terrain between two steps is lost.
    bool snap = false;
    int threads = 0;  ///< 0: all cores; results are the same at any number
    Progress progress = {};
};

/// Columns x0 + i * step, y0 + j * step; heights z0 + k * step_z.
struct RasterGrid {
    double x0 = 0, y0 = 0, z0 = 0, step = 1, step_z = 1;
    int cols = 0, rows = 0, heights = 0;

    double x_of(int i) const { return x0 + i * step; }
    double y_of(int j) const { return y0 + j * step; }
    double z_of(int k) const { return z0 + k * step_z; }
    /// Returns the lowest step at or above this height, to touch_tolerance; `heights` if there is none.
    SPAWNFIELD_API int step_above(double height) const;
};

struct RasterPose {
    double x, y, z;
    /// The layer that is its ground (2D, snap: that it was placed on), 0 the highest; -1: its ground is no layer.
    /// Layers that are no ground for the query (2D: RasterOptions::z, the map's z limits) are not counted.
    std::int32_t layer;
    Verdict verdict;
    bool snapped = false;  ///< 3D: on a layer, in place of a step
};

struct RasterResult {
    int dims = 2;
    RasterGrid grid;
    Area area = {};  ///< outside of which columns were left out
    double yaw = 0, offset = 0;
    ZRange z = {};                  ///< 2D: heights of the layers that are ground
    std::vector<RasterPose> poses;  ///< y after y, x fastest, from the top down; of 3D rasters without the aerial ones
    VerdictCounts counts;           ///< of all poses, the aerial ones too
    std::uint64_t exact_checks = 0;
};

/// Returns the verdict on every pose of a raster. Throws ArgumentError for options beyond their limits, bounds the
/// wrong way round or more than 2^31 columns, FileError for a damaged map.
SPAWNFIELD_API RasterResult raster(const Judge& judge, const RasterOptions& options);

/// Calls visit for each pose of a raster in their order; with `aerial` also for the aerial ones of a 3D raster that it
/// does not list, in their places.
SPAWNFIELD_API void for_each_pose(const RasterResult& raster, bool aerial,
                                  const std::function<void(const RasterPose&)>& visit);

struct Spawn {
    Vec3 position;
    double yaw;  ///< rad
};

struct SpawnList {
    std::vector<Spawn> spawns;       ///< in the order in which they were found
    VerdictCounts counts;            ///< of the positions that were judged
    std::uint64_t draws = 0;         ///< all of them
    std::uint64_t off_area = 0;      ///< draws outside the options' area
    std::uint64_t near_avoided = 0;  ///< draws too near to a point of the options' `avoid`
    std::uint64_t too_close = 0;     ///< draws nearer than min_distance to an earlier one
    std::uint64_t exact_checks = 0;
    bool is_full = false;  ///< sample: fewer than count, and proven that none fits beside them and the avoided points
    double undecided_area = 0;  ///< sample, if fewer and not proven: horizontal m2 in which one may still fit
};

/// Greatest number of spawns: more than anybody starts, and what still fits into memory.
inline constexpr std::size_t max_spawns = 100000000;

/// Points that positions keep a distance from, for example robots that are placed already.
struct AvoidedPoints {
    std::string name = {};          ///< for the user: the file that they come from
    std::vector<Vec3> points = {};  ///< finite, m
    double distance = 0;  ///< m between a point and a position (in 3D), >= 0; exactly this distance is allowed
};

struct SearchOptions {
    std::size_t count = 1;    ///< 1 .. max_spawns
    double min_distance = 0;  ///< m between positions, >= 0
    bool random_yaw = false;  ///< uniform in [-pi, pi), else yaw
    double yaw = 0;           ///< rad
    std::uint64_t seed = 0;
    Bounds bounds = {};  ///< box of the draws; empty: the map's
    /// Positions lie in this area. Draws elsewhere are failures that are not judged (SpawnList::off_area); draws are
    /// made from its bounds only.
    Area area = {};
    /// Draws nearer to one of these points than its distance are failures that are not judged
    /// (SpawnList::near_avoided).
    std::vector<AvoidedPoints> avoid = {};
    std::uint64_t max_failures = 100000;  ///< draws in a row that gave nothing, >= 1
    int threads = 0;                      ///< 0: all cores; results are the same at any number
    Progress progress = {};
};

/// Returns spawns from a random search (Ropelato): uniform draws in a box; each must keep min_distance to all positions
/// judged before; stops after count valid ones or max_failures draws in a row without one. Draws too near to an avoided
/// point are failures. Throws ArgumentError for options beyond their limits, FileError for a damaged map.
SPAWNFIELD_API SpawnList search(const Judge& judge, const SearchOptions& options);

struct SampleOptions {
    std::size_t count = 1;    ///< 1 .. max_spawns
    double min_distance = 0;  ///< m between positions, >= 0
    bool random_yaw = false;  ///< uniform in [-pi, pi), else yaw
    double yaw = 0;           ///< rad
    std::uint64_t seed = 0;
    std::optional<double> offset =
        {};  ///< m of the origin above its layer, at most max_height; no value: auto_offset()
    LayerChoice layers = {};
    ZRange z = {};       ///< layers beyond these heights, m, or beyond the map's z limits are no ground
    Bounds bounds = {};  ///< in x and y; empty: the map's
    Area area = {};      ///< as SearchOptions::area
    std::vector<AvoidedPoints> avoid = {};  ///< as SearchOptions::avoid
    int threads = 0;                        ///< 0: all cores; results are the same at any number
    Progress progress = {};
};

/// Returns valid poses distributed uniformly by horizontal area over the feasible region of all chosen layers, each
/// confirmed exactly, at least min_distance apart, none nearer to a point of `avoid` than its distance.
///
/// When draws keep failing, it goes over to cells that cover the region. Cells in which no further spawn can stand are
/// proven so from the scene's geometry and left out; the others are drawn from, uniformly by area as before, and split.
/// It ends with fewer than count when no cell remains (is_full), or when the cells are too small (0.1 mm) or too many
/// to go on. Throws ArgumentError for options beyond their limits, FileError for a damaged map. Sources: White, Cline,
/// Egbert, Poisson disk point sets by hierarchical dart throwing, 2007; Ebeida et al., A simple algorithm for maximal
/// Poisson-disk sampling in high dimensions, 2012.
SPAWNFIELD_API SpawnList sample(const Judge& judge, const SampleOptions& options);

}  // namespace spawnfield
