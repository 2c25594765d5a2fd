#pragma once

#include "base/rect.h"
#include "free_space/bounds_tile.h"
#include "free_space/cell_range.h"
#include "free_space/footprint.h"
#include "free_space/row_columns.h"
#include "free_space/row_maxima.h"

#include <spawnfield/column.h>
#include <spawnfield/free_space.h>

#include <array>
#include <limits>
#include <optional>

namespace spawnfield {

struct FreeSpace::Impl {
    SolidBounds bounds;
    Robot robot;
    std::vector<Footprint> ahead;  ///< upright robot, at yaw 0
    std::vector<Footprint> every_yaw;
};

/// Proves poses free or blocked for one thread. Keeps what neighbouring poses share: the footprints at one rotation,
/// and the cells that they cover from one row of poses (equal y).
class Mask {
public:
    /// The robot is upright at this yaw until another rotation is set.
    explicit Mask(const FreeSpace::Impl& space, double yaw = 0)
        : space_(space), raster_(space.bounds.impl()),
          farthest_(raster_.levels().empty() ? 0 : 1e8 * raster_.levels()[0].cell)
    {
        set_rotation(yaw);
    }

    void set_rotation(double yaw);            ///< upright robot
    void set_rotation(const Mat3& rotation);  ///< any rotation; poses of a tilted robot are never Blocked
    void set_every_yaw();                     ///< upright robot; proofs hold for every yaw
    /// From now on, proofs use only the coarsest cells that are useful. They read few tiles, and prove less.
    void use_coarse_cells() { coarse_only_ = true; }
    /// From now on, nothing is proven where cells have several intervals (under trees, at walls), unless the coarsest
    /// ones around the part are clear: for callers whose exact check takes less time than a look at cells one by one.
    void leave_layered_cells() { leaves_layered_ = true; }
    Proof proof_of(const Vec3& position);
    /// Sets out[i] to the proof of the pose (x[i], y, z[i]), which is faster than one pose after the other. The x of
    /// the poses are ascending. Poses whose z[i] is NaN are not looked at, and are not Blocked. If a pose is more than
    /// 1e8 cells away, no pose of the row has a proof.
    void prove(std::span<const double> x, double y, std::span<const double> z, std::span<Proof> out);
    /// Returns whether a solid on the vertical line through the origin is certainly inside a part. `spans` are the
    /// spans of that line.
    bool is_pierced(std::span<const Span> spans, double z) const;

private:
    /// The cells of one row that a part covers (low .. high), and those completely under its inner prism (inner_low ..
    /// inner_high). All four are x, in cells from the robot's origin.
    struct CoverRow {
        int row;
        double low, high, inner_low, inner_high;
    };
    /// What the cells around a part are like. Clear: the part is above the lowest interval of each cell, and below the
    /// next one, if there is one. Plain: it is not, and each cell has one interval. Layered: a cell has several.
    /// Only after look_closer(): Hit: something is certainly inside the part. Unclear: no cell proves anything.
    enum class Surroundings : std::uint8_t { Clear, Plain, Layered, Hit, Unclear };
    /// What look_closer() finds in the cells around a part: something above its lowest point, something of which these
    /// cells do not say enough, and something that is certainly inside the part.
    enum Found : std::uint8_t { Above = 1, Undecided = 2, Inside = 4 };
    struct OpenTile {
        BoundsTile tile;
        static constexpr std::uint32_t none = 0xffffffff;
        std::uint32_t col = none, row = none;
        double inverse_quantum = 0;  ///< of the tile

        bool are_below(std::uint16_t top, double z) const
        {
            return top < (z - tile.base) * inverse_quantum || top == 0;
        }
        /// Begins to fetch some rows of cells from memory. GCC drops calls of functions that only prefetch (ipa-pure),
        /// unless they are inlined.
        [[gnu::always_inline]] void fetch(const CellRange& rows) const
        {
            constexpr std::uint32_t in_line = 64 / sizeof(std::uint16_t);
            for (int r = rows.first; r <= rows.last; ++r)
                for (std::uint32_t c = 0; c < BoundsTile::side; c += in_line)
                    __builtin_prefetch(tile.tops + std::uint32_t(r) * BoundsTile::side + c);
            if (rows.first <= rows.last && tile.bounds.marks != nullptr)
                __builtin_prefetch(tile.bounds.marks + rows.first);
        }
    };
    /// Some rows of cells of a tile, seen together.
    struct TileRows {
        const OpenTile* open = nullptr;                            ///< the tile; valid until the next tile is opened
        std::uint32_t col = OpenTile::none, row = OpenTile::none;  ///< of the tile
        CellRange rows = no_cells, core_rows = no_cells;           ///< counted from the tile's first row
        RowMaxima whole, core;                                     ///< tops in `rows`, and in `core_rows`
        /// A bit for each column in which a cell of `rows` has a list of intervals, or of points that are solid.
        std::uint64_t listed = 0, filled = 0;
        /// If a column is listed: the highest top of the lowest intervals, and the lowest bottom of the second ones.
        RowMaxima::Values floors{}, ceilings{};
        bool has_gaps = false;  ///< floors and ceilings are set for these rows

        void set(const OpenTile& opened, const CellRange& all, int wide, const CellRange& inner = no_cells,
                 int inner_wide = 1);
        void set_gaps();
        void look_around(std::span<const RowColumns::Seen> columns, const Prism& part, std::span<const double> z,
                         std::span<Surroundings> out);
        Surroundings between_layers(std::uint64_t columns, double bottom, double top);
        std::uint8_t look_closer(const RowColumns::Seen& columns, const Footprint& part, double z) const;
    };
    struct Pass {
        /// The tiles that were used last: adjacent ones, and all that a block of a raster needs, or most of them.
        static constexpr std::uint32_t tile_cols = 16, tile_rows = 2;  ///< columns and rows of these tiles

        std::size_t level;
        double per_cell = 0;               ///< 1 / size of a cell, 1/m
        int known_cols, known_rows;        ///< of cells
        bool is_ready = false;             ///< `rows` are those of the last y
        std::vector<CoverRow> rows;        ///< in the order of their numbers
        std::vector<CellRange> undecided;  ///< for each row: all other cells are proven free at the last pose
        std::array<OpenTile, tile_cols * tile_rows> tiles;
        RowColumns columns;                                       ///< of the poses of a row
        bool has_columns = false;                                 ///< `columns` are those of row_x_
        double last_y = std::numeric_limits<double>::infinity();  ///< of the last row of poses, m
        TileRows last_rows;                                       ///< that were seen
    };
    struct Part {
        Footprint footprint;
        Rect reach;                ///< around the outer polygon, relative to the robot's origin, m
        std::vector<Pass> passes;  ///< coarse to fine
        bool is_around_origin;     ///< the origin is inside the polygon of the inner prism
        /// Around the inner polygon, if both polygons are rectangles along the axes, as for a box at yaw 0.
        std::optional<Rect> core;
    };
    struct Heights;

    void set_footprints(const std::vector<Footprint>& footprints, double cosine, double sine);
    void choose_passes(Part& part) const;
    void set_level(std::size_t level, Pass& pass) const;
    void set_y(double y);
    void cover(const Part& part, Pass& pass) const;
    void cover_rectangle(const Part& part, Pass& pass) const;
    const OpenTile& tile_of(Pass& pass, std::uint32_t col, std::uint32_t row) const;
    void open_tile(std::size_t level, std::uint32_t col, std::uint32_t row, OpenTile& out) const;
    static CellRange open_cells(const Pass& pass, const CoverRow& cover, const Pass* coarser, double u);
    bool is_in_reach(double x, double y) const;
    Surroundings surroundings_of(const Part& part, Pass& pass, const Vec3& position) const;
    static Surroundings between_layers(const OpenTile& open, const CellRange& cols, const CellRange& rows,
                                       double bottom, double top);
    void set_row(std::span<const double> x);
    const RowColumns& columns_of(const Part& part, Pass& pass) const;
    CellRange next_rows(const Part& part, Pass& pass, double y, const CellRange& rows) const;
    void look_around(const Part& part, Pass& pass, double y, std::span<const double> z,
                     std::span<Surroundings> out) const;
    static Pass& second_pass(Part& part);
    void look_closer(const Part& part, Pass& pass, double y, std::span<const double> z, std::span<Surroundings> out);
    static bool is_hit(const BoundsTile& tile, std::uint32_t cell, const Heights& heights);
    static bool is_free(const BoundsTile& tile, std::uint32_t cell, const Heights& heights);
    Proof proof_near(Part& part, const Vec3& position, Surroundings surroundings);
    std::optional<Proof> proof_of_rectangle(const Part& part, Pass& pass, const Vec3& position) const;
    Proof proof_of(const Part& part, Pass& pass, const Pass* coarser, double x, double z) const;

    const FreeSpace::Impl& space_;
    const SolidBounds::Impl& raster_;
    const double farthest_;  ///< m from the raster's corner; the numbers of cells up to there fit an int
    std::vector<Part> parts_;
    bool coarse_only_ = false, leaves_layered_ = false;
    std::vector<double> row_x_;                            ///< x of the poses of the last row
    std::vector<Surroundings> surroundings_;               ///< of these poses
    std::vector<std::uint8_t> found_;                      ///< Found bits of these poses
    double y_ = std::numeric_limits<double>::quiet_NaN();  ///< y of the last pose that was not clear; for pass.rows
};

}  // namespace spawnfield
