#pragma once

#include <spawnfield/export.h>
#include <spawnfield/query.h>

#include <filesystem>
#include <string>
#include <utility>
#include <vector>

/// Results as the tools of the MSc thesis (Ropelato: feasible spawn locations in Unity) read them: a folder of text
/// files.
namespace spawnfield {

/// Unity's frame is left-handed with y up: (x, y, z) there is our (x, z, y), metres.
inline Vec3 unity_from(const Vec3& point) { return {point.x(), point.z(), point.y()}; }

enum class ThesisClass : std::uint8_t { Valid, Invalid, Aerial };
inline constexpr std::size_t thesis_class_count = 3;

/// valid is valid, aerial and off_terrain are aerial, the rest is invalid.
SPAWNFIELD_API ThesisClass thesis_class_of(Verdict verdict);

/// All files of a thesis folder; Air_Locations.txt is there only if it was asked for.
inline constexpr std::array thesis_files{"Valid_Locations.txt", "Invalid_Locations.txt", "Air_Locations.txt",
                                         "Stats.txt", "RunTime.txt"};

/// Lines of a file, by class: those that were written.
using ThesisCounts = std::array<std::uint64_t, thesis_class_count>;

/// Writes the locations' files into a folder: a line "x, y, z" per pose in Unity's frame, numbers that read back to the
/// same double. With `air` also Air_Locations.txt, of 3D rasters with the aerial poses that `raster` leaves out. Throws
/// OutputError.
SPAWNFIELD_API ThesisCounts write_thesis_locations(const std::filesystem::path& folder, const RasterResult& raster,
                                                   bool air, const Progress& progress = {});

/// Spawns are valid locations. No others are kept, so Invalid_Locations.txt is empty: thesis_stats counts them.
SPAWNFIELD_API ThesisCounts write_thesis_locations(const std::filesystem::path& folder, const SpawnList& list);

/// Stats.txt: "Name: value" per line: the settings, what was judged by class and by verdict, and the lines of each
/// file.
SPAWNFIELD_API std::string thesis_stats(const std::vector<std::pair<std::string, std::string>>& settings,
                                        const VerdictCounts& counts, const ThesisCounts& written);

}  // namespace spawnfield
