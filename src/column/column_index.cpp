#include "column/bins.h"
#include "scene/elements.h"

#include <spawnfield/column.h>

#include <algorithm>
#include <cmath>

namespace spawnfield {
namespace {

constexpr double pad = 1e-8;  // m; wider than touch_tolerance, so a line on an edge finds its triangle
constexpr int refinement = 4; // between the cell sizes of two levels

struct CellRange {
    std::uint32_t col0, col1, row0, row1;  // inclusive
};

CellRange cells_of(const ColumnIndex& index, const ColumnIndex::Level& level, double x0, double y0, double x1, double y1)
{
    return {bin_number(x0 - index.x0, level.cell, level.cols), bin_number(x1 - index.x0, level.cell, level.cols),
            bin_number(y0 - index.y0, level.cell, level.rows), bin_number(y1 - index.y0, level.cell, level.rows)};
}

template <class Visit>
void visit_bins(const ColumnIndex& index, const ColumnIndex::Level& level, const Bounds& box, Visit visit)
{
    const CellRange range = cells_of(index, level, box.min.x() - pad, box.min.y() - pad, box.max.x() + pad, box.max.y() + pad);
    for (std::uint32_t row = range.row0; row <= range.row1; ++row)
        for (std::uint32_t col = range.col0; col <= range.col1; ++col) visit(std::size_t{row} * level.cols + col);
}

/// Counting sort of one level's elements into its bins.
void fill_level(const ColumnIndex& index, ColumnIndex::Level& level, const Scene& scene,
                const std::vector<std::uint32_t>& members)
{
    level.offsets.assign(std::size_t{level.rows} * level.cols + 1, 0);
    for (const std::uint32_t element : members)
        visit_bins(index, level, element_bounds(scene, element), [&](std::size_t bin) { ++level.offsets[bin + 1]; });
    for (std::size_t bin = 1; bin < level.offsets.size(); ++bin) level.offsets[bin] += level.offsets[bin - 1];
    level.elements.resize(level.offsets.back());
    std::vector<std::uint32_t> next(level.offsets.begin(), level.offsets.end() - 1);
    for (const std::uint32_t element : members)
        visit_bins(index, level, element_bounds(scene, element),
                   [&](std::size_t bin) { level.elements[next[bin]++] = element; });
}

}  // namespace

ColumnIndex build_column_index(const Scene& scene)
{
    ColumnIndex index;
    const std::size_t elements = element_count(scene);
    const Bounds bounds = scene.bounds();
    if (elements == 0) return index;
    index.x0 = bounds.min.x() - pad;
    index.y0 = bounds.min.y() - pad;
    const double width = bounds.max.x() - bounds.min.x() + 2 * pad;
    const double depth = bounds.max.y() - bounds.min.y() + 2 * pad;
    const double extent = std::max(width, depth);

    // About four bins an element where they are spread evenly; never more than 2^24 bins however thin the scene is.
    const double finest = std::max(std::sqrt(width * depth / double(elements)) / 2, extent / 4096);
    std::vector<std::vector<std::uint32_t>> members(1);
    for (std::uint32_t element = 0; element < elements; ++element) {
        const Bounds box = element_bounds(scene, element);
        const double size = std::max(box.max.x() - box.min.x(), box.max.y() - box.min.y()) + 2 * pad;
        std::size_t level = 0;
        for (double cell = finest; cell < size; cell *= refinement) ++level;
        if (level >= members.size()) members.resize(level + 1);
        members[level].push_back(element);
    }
    double cell = finest;
    for (const auto& level_members : members) {
        if (!level_members.empty()) {
            ColumnIndex::Level level;
            level.cell = cell;
            level.cols = static_cast<std::uint32_t>(std::ceil(width / cell));
            level.rows = static_cast<std::uint32_t>(std::ceil(depth / cell));
            fill_level(index, level, scene, level_members);
            index.levels.push_back(std::move(level));
        }
        cell *= refinement;
    }
    return index;
}

void find_elements(const ColumnIndex& index, double x0, double y0, double x1, double y1, std::vector<std::uint32_t>& out)
{
    out.clear();
    bool repeated = false;
    for (const ColumnIndex::Level& level : index.levels) {
        // Not past the rim: clamping would answer with the elements there.
        if (x1 < index.x0 || y1 < index.y0 || x0 > index.x0 + level.cell * level.cols ||
            y0 > index.y0 + level.cell * level.rows)
            continue;
        const CellRange range = cells_of(index, level, x0, y0, x1, y1);
        repeated = repeated || range.col0 != range.col1 || range.row0 != range.row1;
        for (std::uint32_t row = range.row0; row <= range.row1; ++row)
            for (std::uint32_t col = range.col0; col <= range.col1; ++col) {
                const std::size_t bin = std::size_t{row} * level.cols + col;
                out.insert(out.end(), level.elements.begin() + level.offsets[bin],
                           level.elements.begin() + level.offsets[bin + 1]);
            }
    }
    std::sort(out.begin(), out.end());
    if (repeated) out.erase(std::unique(out.begin(), out.end()), out.end());
}

}  // namespace spawnfield
