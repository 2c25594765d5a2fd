#pragma once

#include <spawnfield/scene.h>

namespace spawnfield {

/// Elements of a scene binned by where they are seen from above, on grids of growing cell size.
///
/// Element e is triangle e, or primitive e - triangles. Each lies in the at most 2 x 2 bins that it overlaps on the first
/// level whose cells are no smaller than it. About 8 bytes per element and bin; built in O(elements).
struct ColumnIndex {
    struct Level {
        double cell = 0;                     ///< m
        std::uint32_t cols = 0, rows = 0;
        std::vector<std::uint32_t> offsets;  ///< rows * cols + 1 starts into elements; row 0 is the smallest y
        std::vector<std::uint32_t> elements; ///< ascending within a bin
    };
    double x0 = 0, y0 = 0;  ///< corner that all levels share
    std::vector<Level> levels;
};

ColumnIndex build_column_index(const Scene& scene);

/// Elements whose bins meet the closed rectangle, ascending, each once; a superset of those that do.
void find_elements(const ColumnIndex& index, double x0, double y0, double x1, double y1, std::vector<std::uint32_t>& out);

/// One piece's interval on a vertical line; a sheet's has no length.
struct Span {
    double bottom = 0, top = 0;
    std::uint32_t part = 0;
    bool terrain = false;  ///< a robot may stand on its top
};

/// What stands on the vertical line through (x, y). DESIGN.md, Definitions.
struct Column {
    std::vector<Span> spans;     ///< every single piece's, terrain and obstacle, highest top first; not joined
    std::vector<double> layers;  ///< upper ends of joined terrain, from the top down
    std::vector<double> water;   ///< water surfaces, from the top down
};

/// Layers closer than this are one, and intervals closer than this are joined, m.
inline constexpr double layer_tolerance = 1e-6;

/// Exact intervals along the vertical line through (x, y).
///
/// A filled mesh counts as inside between odd and even crossings (crossing number with one decision per edge, so a line
/// through an edge or corner is counted once); lines along its surface count too. Sheets: triangles seen edge-on give
/// nothing. Source: Haines, Point in Polygon Strategies, Graphics Gems IV, 1994 (crossings test).
Column column_at(const Scene& scene, const ColumnIndex& index, double x, double y);

struct Ground {
    double height = 0;
    bool terrain = false;
    std::uint32_t part = 0;
};

/// The highest upper end of a single span at or below z; within touch_tolerance terrain wins.
std::optional<Ground> ground_below(const Column& column, double z);

}  // namespace spawnfield
