#include "base/binary.h"
#include "base/text.h"
#include "export/words.h"
#include "picture/palette.h"

#include <spawnfield/map_export.h>

namespace spawnfield {
namespace {

std::string header(std::size_t points, bool is_settled, const std::vector<std::string>& comment)
{
    std::string text = "ply\nformat binary_little_endian 1.0\n";
    for (const std::string& line : comment) text += "comment " + one_line(line) + "\n";
    text += "comment verdict: " + verdict_numbers() + "\nelement vertex " + std::to_string(points) + "\n";
    for (const char* const axis : {"x", "y", "z"}) text += std::string("property double ") + axis + "\n";
    for (const char* const name : {"red", "green", "blue", "verdict"})
        text += std::string("property uchar ") + name + "\n";
    if (is_settled)
        for (const char* const name : {"roll", "pitch", "tilt", "margin"})
            text += std::string("property double ") + name + "\n";
    return text + "end_header\n";
}

void put(BinaryWriter& out, const RasterPose& pose)
{
    for (const double coordinate : {pose.x, pose.y, pose.z}) out.put(coordinate);
    const std::uint32_t colour = verdict_palette[std::size_t(pose.verdict)];
    for (const int shift : {16, 8, 0}) out.put(std::uint8_t(colour >> shift));
    out.put(std::uint8_t(pose.verdict));
}

void put(BinaryWriter& out, const RasterRest& rest)
{
    for (const double value : {rest.roll, rest.pitch, rest.tilt, rest.margin}) out.put(value);
}

}  // namespace

void write_ply(const RasterResult& raster, const std::vector<std::string>& comment,
               const std::function<void(std::string_view)>& sink)
{
    constexpr std::size_t points_per_piece = 10000;
    const bool is_settled = raster.stance == Stance::Settled && raster.rests.size() == raster.poses.size();
    sink(header(raster.poses.size(), is_settled, comment));
    for (std::size_t first = 0; first < raster.poses.size(); first += points_per_piece) {
        BinaryWriter piece;
        for (std::size_t p = first; p < std::min(first + points_per_piece, raster.poses.size()); ++p) {
            put(piece, raster.poses[p]);
            if (is_settled) put(piece, raster.rests[p]);
        }
        sink(piece.take());
    }
}

}  // namespace spawnfield
