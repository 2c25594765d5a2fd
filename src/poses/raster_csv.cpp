#include "base/number.h"
#include "poses/line_texts.h"
#include "poses/pose_columns.h"

#include <spawnfield/error.h>
#include <spawnfield/poses.h>
#include <spawnfield/raster_cells.h>

#include <algorithm>
#include <array>
#include <bit>
#include <charconv>
#include <cstdint>
#include <cstring>
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
    /// Does the same as write_number().
    char* write(char* to, double value)
    {
        const auto bits = std::bit_cast<std::uint64_t>(value);
        Known& known = known_[bits * 0x9e3779b97f4a7c15 >> (64 - index_bits)];  // multiplicative hashing (Knuth)
        if (known.size == 0 || known.bits != bits) {
            known.bits = bits;
            known.size = std::size_t(write_number(known.text.data(), value) - known.text.data());
        }
        std::memcpy(to, known.text.data(), number_room);
        return to + known.size;
    }

private:
    static constexpr int index_bits = 12;
    struct Known {
        std::uint64_t bits = 0;
        std::size_t size = 0;  ///< of the text, characters; 0: not made yet
        std::array<char, number_room> text{};
    };
    std::vector<Known> known_{std::size_t{1} << index_bits};  // 192 kB
};

char* write_text(char* to, std::string_view text) { return std::copy(text.begin(), text.end(), to); }
char* write_comma(char* to) { return write_text(to, ","); }

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
        std::array<char, 8 * number_room> line;  // at most six numbers, a layer and a verdict
        char* end = write_comma(numbers.write(line.data(), pose.x));
        end = write_comma(numbers.write(end, pose.y));
        end = write_comma(write_number(end, pose.z));
        if (is_settled_)
            for (const double angle : {rest->roll, rest->pitch}) end = write_comma(write_number(end, angle));
        end = write_comma(rule_ && is_settled_ ? write_number(end, rest->yaw) : write_text(end, yaw_));
        if (pose.layer >= 0) end = std::to_chars(end, end + number_room, pose.layer).ptr;
        end = write_text(write_comma(end), to_string(pose.verdict));
        text.append(line.data(), end);
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
    std::vector<std::string> texts;
    std::size_t written = 0;  // poses
    const auto write = [&](std::span<const RasterPose> poses) {
        write_lines(poses.size(), threads, sink, texts, [&](std::string& text, std::size_t first, std::size_t end) {
            for (std::size_t i = first; i < end; ++i) {
                lines.append(text, poses[i], lines.is_settled() ? &raster.rests[written + i] : nullptr);
                text += '\n';
            }
        });
        written += poses.size();
    };
    if (raster.grid.first_row == 0) sink(lines.header() + "\n");
    if (!aerial || raster.dims != 3) {
        write(raster.poses);
        return;
    }
    std::vector<RasterPose> batch;
    batch.reserve(std::min<std::size_t>(batch_lines, raster.counts.total()));
    for_each_pose(raster, aerial, [&](const RasterPose& pose) {
        batch.push_back(pose);
        if (batch.size() < batch_lines) return;
        write(batch);
        batch.clear();
    });
    write(batch);
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
