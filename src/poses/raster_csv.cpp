#include "base/number.h"
#include "poses/line_texts.h"
#include "poses/pose_columns.h"

#include <spawnfield/error.h>
#include <spawnfield/poses.h>
#include <spawnfield/raster_cells.h>

#include <bit>
#include <cstdint>
#include <span>

namespace spawnfield {
namespace {

/// Appends the tilt and what follows it in the lines of a settled raster.
void append_rest(std::string& text, const RasterRest& rest, const std::optional<HeadingRule>& rule)
{
    for (const double value : {rest.tilt, rest.margin, rest.tip_over, rest.belly}) append_if_known(text, value);
    if (rule && rule->has_several()) (text += ',') += std::to_string(rest.valid_headings);
    append_if_known(text, rest.layer_height);
    if (!free_length_column(rule).empty()) append_if_known(text, rest.free_length);
}

/// Returns the header of a settled raster.
std::string settled_raster_header(const std::optional<HeadingRule>& rule)
{
    std::string names = "x,y,z,roll,pitch,yaw,layer,verdict,tilt,margin,tip_over,belly";
    if (rule && rule->has_several()) names += ",valid_headings";
    names += ",ground";
    if (const std::string name = free_length_column(rule); !name.empty()) names += "," + name;
    return names;
}

/// Texts of numbers that repeat: x and y of a raster. Making a text takes much longer than finding it.
class RepeatedNumbers {
public:
    /// The text is valid until the next call.
    const std::string& text_of(double value)
    {
        const auto bits = std::bit_cast<std::uint64_t>(value);
        Known& known = known_[bits * 0x9e3779b97f4a7c15 >> (64 - index_bits)];  // multiplicative hashing (Knuth)
        if (known.text.empty() || known.bits != bits) known = {bits, number(value)};
        return known.text;
    }

private:
    static constexpr int index_bits = 12;
    struct Known {
        std::uint64_t bits = 0;
        std::string text;  ///< empty: not made yet
    };
    std::vector<Known> known_{std::size_t{1} << index_bits};  // 160 kB
};

/// Makes the lines of a raster's poses.
class PoseLines {
public:
    explicit PoseLines(const RasterResult& raster)
        : rule_(raster.heading), yaw_(number(raster.yaw)),
          is_settled_(!raster.rests.empty() || (raster.stance == Stance::Settled && raster.poses.empty()))
    {
        if (is_settled_ && raster.rests.size() != raster.poses.size())
            throw ArgumentError("write_raster_csv", "size of raster.rests", double(raster.rests.size()),
                                "as many as its poses, or none");
    }

    bool is_settled() const { return is_settled_; }
    std::string header() const { return is_settled_ ? settled_raster_header(rule_) : "x,y,z,yaw,layer,verdict"; }

    /// Appends the line of a pose, without its end. `rest` is only used for settled poses.
    void append(std::string& text, const RasterPose& pose, const RasterRest* rest) const
    {
        thread_local RepeatedNumbers numbers;
        text += numbers.text_of(pose.x);
        text += ',';
        text += numbers.text_of(pose.y);
        text += ',';
        append_number(text, pose.z);
        if (is_settled_) {
            text += ',';
            append_numbers(text, {rest->roll, rest->pitch});
        }
        ((text += ',') += rule_ && is_settled_ ? number(rest->yaw) : yaw_) += ',';
        if (pose.layer >= 0) text += std::to_string(pose.layer);
        text += ',';
        text += to_string(pose.verdict);
        if (is_settled_) append_rest(text, *rest, rule_);
    }

private:
    const std::optional<HeadingRule> rule_;
    const std::string yaw_;
    const bool is_settled_;
};

}  // namespace

void write_raster_csv(const RasterResult& raster, bool aerial, const std::function<void(std::string_view)>& sink,
                      int threads)
{
    const PoseLines lines(raster);
    std::vector<RasterPose> poses;
    poses.reserve(std::min<std::size_t>(batch_lines, raster.counts.total()));
    std::vector<std::string> texts;
    std::size_t written = 0;  // poses
    const auto write = [&] {
        write_lines(poses.size(), threads, sink, texts, [&](std::string& text, std::size_t first, std::size_t end) {
            for (std::size_t i = first; i < end; ++i) {
                lines.append(text, poses[i], lines.is_settled() ? &raster.rests[written + i] : nullptr);
                text += '\n';
            }
        });
        written += poses.size();
        poses.clear();
    };
    if (raster.grid.first_row == 0) sink(lines.header() + "\n");
    for_each_pose(raster, aerial, [&](const RasterPose& pose) {
        poses.push_back(pose);
        if (poses.size() == batch_lines) write();
    });
    write();
}

void write_raster_cells_csv(const RasterResult& raster, const std::vector<RasterCell>& cells,
                            const std::function<void(std::string_view)>& sink, int threads)
{
    const PoseLines lines(raster);
    const RasterGrid& grid = raster.grid;
    sink(lines.header() + ",size,x_low,y_low,z_low,z_high\n");
    std::vector<std::string> texts;
    write_lines(cells.size(), threads, sink, texts, [&](std::string& text, std::size_t first, std::size_t end) {
        for (std::size_t i = first; i < end; ++i) {
            const RasterCell& cell = cells[i];
            const RasterPose& pose = raster.poses[cell.pose];
            lines.append(text, pose, lines.is_settled() ? &raster.rests[cell.pose] : nullptr);
            text += ',';
            append_numbers(text, {cell.side * grid.step, grid.x_of(cell.col) - grid.step / 2,
                                  grid.y_of(cell.row) - grid.step / 2, cell.low, cell.high});
            text += '\n';
        }
    });
}

}  // namespace spawnfield
