#include <spawnfield/raster_cells.h>

#include <spawnfield/error.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <unordered_map>

namespace spawnfield {
namespace {

constexpr int parts = 2;  // along a side of a square that is divided

/// What the columns of a square have in common. Columns with equal poses have equal numbers.
using Kind = std::uint32_t;
constexpr Kind empty = 0;  // no poses
constexpr Kind mixed = std::numeric_limits<Kind>::max();

/// Squares of columns. Each one consists of four squares of the level below.
struct Level {
    int cols, rows, side;
    std::vector<Kind> kinds;  ///< row after row

    Kind& at(int col, int row) { return kinds[std::size_t(row) * std::size_t(cols) + std::size_t(col)]; }
    Kind at(int col, int row) const { return kinds[std::size_t(row) * std::size_t(cols) + std::size_t(col)]; }
};

/// Numbers the kinds of columns, in the order of their first columns.
class KindNumbers {
public:
    explicit KindNumbers(const RasterResult& raster) : raster_(raster) {}

    /// Returns the number of the kind of a column with the poses first .. end - 1.
    Kind of(std::size_t first, std::size_t end)
    {
        if (first == end) return empty;
        if (is_like_last(first, end)) return last_kind_;
        last_first_ = first;
        last_end_ = end;
        text_.clear();
        for (std::size_t p = first; p < end; ++p) append(p);
        return last_kind_ = kinds_.try_emplace(text_, Kind(kinds_.size() + 1)).first->second;
    }

private:
    /// Most columns are like the one before; this takes less time than making their texts.
    bool is_like_last(std::size_t first, std::size_t end) const
    {
        if (end - first != last_end_ - last_first_) return false;
        for (std::size_t p = first, q = last_first_; p < end; ++p, ++q) {
            if (raster_.poses[p].layer != raster_.poses[q].layer) return false;
            if (raster_.poses[p].verdict != raster_.poses[q].verdict) return false;
            if (!raster_.rests.empty() && raster_.rests[p].valid_headings != raster_.rests[q].valid_headings)
                return false;
        }
        return true;
    }

    void append(std::size_t p)
    {
        const RasterPose& pose = raster_.poses[p];
        (text_ += std::to_string(pose.layer)) += ' ';
        text_ += char('a' + int(pose.verdict));
        if (!raster_.rests.empty()) text_ += std::to_string(raster_.rests[p].valid_headings);
        text_ += ' ';
    }

    const RasterResult& raster_;
    std::size_t last_first_ = 0, last_end_ = 0;  ///< poses of the last column that had a new text
    Kind last_kind_ = empty;
    std::string text_;  ///< describes a kind
    std::unordered_map<std::string, Kind> kinds_;
};

/// The columns of a raster with the squares that they form.
class Squares {
public:
    explicit Squares(const RasterResult& raster) : raster_(raster)
    {
        find_columns();
        while (levels_.back().cols > 1 || levels_.back().rows > 1) levels_.push_back(coarser(levels_.back()));
    }

    std::vector<RasterCell> cells() const
    {
        std::vector<RasterCell> out;
        visit(levels_.size() - 1, 0, 0, out);
        std::sort(out.begin(), out.end(), [](const RasterCell& a, const RasterCell& b) { return a.pose < b.pose; });
        return out;
    }

private:
    std::size_t number(int col, int row) const
    {
        return std::size_t(row) * std::size_t(raster_.grid.cols) + std::size_t(col);
    }

    void find_columns()
    {
        const RasterGrid& grid = raster_.grid;
        const std::size_t columns = std::size_t(grid.cols) * std::size_t(grid.rows);
        first_pose_.assign(columns + 1, 0);
        for (const RasterPose& pose : raster_.poses) {
            const auto col = int(std::lround((pose.x - grid.x0) / grid.step));
            const auto row = int(std::lround((pose.y - grid.y0) / grid.step));
            ++first_pose_[number(col, row) + 1];
        }
        for (std::size_t i = 1; i <= columns; ++i) first_pose_[i] += first_pose_[i - 1];
        Level level{grid.cols, grid.rows, 1, std::vector<Kind>(columns)};
        KindNumbers numbers(raster_);
        for (std::size_t i = 0; i < columns; ++i) level.kinds[i] = numbers.of(first_pose_[i], first_pose_[i + 1]);
        levels_.push_back(std::move(level));
    }

    /// A square that lies partly beyond the grid is mixed.
    Level coarser(const Level& fine) const
    {
        Level out{(fine.cols + parts - 1) / parts, (fine.rows + parts - 1) / parts, fine.side * parts, {}};
        out.kinds.resize(std::size_t(out.cols) * std::size_t(out.rows));
        for (int row = 0; row < out.rows; ++row)
            for (int col = 0; col < out.cols; ++col) out.at(col, row) = joined(fine, col * parts, row * parts);
        return out;
    }

    static Kind joined(const Level& fine, int first_col, int first_row)
    {
        if (first_col + parts > fine.cols || first_row + parts > fine.rows) return mixed;
        const Kind kind = fine.at(first_col, first_row);
        for (int row = first_row; row < first_row + parts; ++row)
            for (int col = first_col; col < first_col + parts; ++col)
                if (fine.at(col, row) != kind) return mixed;
        return kind;
    }

    void visit(std::size_t l, int col, int row, std::vector<RasterCell>& out) const
    {
        const Level& level = levels_[l];
        if (col >= level.cols || row >= level.rows || level.at(col, row) == empty) return;
        if (level.at(col, row) != mixed) {
            add_cells(col * level.side, row * level.side, level.side, out);
            return;
        }
        for (int j = 0; j < parts; ++j)
            for (int i = 0; i < parts; ++i) visit(l - 1, col * parts + i, row * parts + j, out);
    }

    void add_cells(int col, int row, int side, std::vector<RasterCell>& out) const
    {
        const std::size_t middle = number(col + side / 2, row + side / 2);
        for (std::size_t pose = first_pose_[middle]; pose < first_pose_[middle + 1]; ++pose)
            out.push_back(cell_of(col, row, side, pose, pose - first_pose_[middle]));
    }

    /// `layer` counts the poses of a column.
    RasterCell cell_of(int col, int row, int side, std::size_t pose, std::size_t layer) const
    {
        RasterCell cell{col, row, side, pose, raster_.poses[pose].z, raster_.poses[pose].z};
        for (int j = row; j < row + side; ++j)
            for (int i = col; i < col + side; ++i) {
                const double z = raster_.poses[first_pose_[number(i, j)] + layer].z;
                cell.low = std::min(cell.low, z);
                cell.high = std::max(cell.high, z);
            }
        return cell;
    }

    const RasterResult& raster_;
    std::vector<std::size_t> first_pose_;  ///< of each column, row after row, and the number of poses
    std::vector<Level> levels_;            ///< from single columns to one square
};

}  // namespace

std::vector<RasterCell> raster_cells(const RasterResult& raster)
{
    if (raster.dims != 2) throw ArgumentError("raster_cells", "raster.dims", raster.dims, "2");
    if (raster.poses.empty()) return {};
    return Squares(raster).cells();
}

}  // namespace spawnfield
