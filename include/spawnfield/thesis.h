#pragma once

#include <spawnfield/export.h>
#include <spawnfield/query.h>

#include <filesystem>
#include <string>
#include <utility>
#include <vector>

/// Writes results as folders of text files, for the tools of the MSc thesis (Ropelato: feasible spawn locations in
/// Unity).
namespace spawnfield {

/// Returns a point in Unity's frame, which is left-handed with y up: our (x, y, z) is (x, z, y) there, in metres.
inline Vec3 unity_from(const Vec3& point) { return {point.x(), point.z(), point.y()}; }

enum class ThesisClass : std::uint8_t { Valid, Invalid, Aerial };
inline constexpr std::size_t thesis_class_count = 3;

/// Returns Valid for valid, Aerial for aerial and off_terrain, and Invalid for all other verdicts.
SPAWNFIELD_API ThesisClass thesis_class_of(Verdict verdict);

/// All files of a thesis folder. Air_Locations.txt exists only if it was asked for.
inline constexpr std::array thesis_files{"Valid_Locations.txt", "Invalid_Locations.txt", "Air_Locations.txt",
                                         "Stats.txt", "RunTime.txt"};

/// Number of lines written to the file of each class.
using ThesisCounts = std::array<std::uint64_t, thesis_class_count>;

/// Writes the files with locations into a folder: a line "x, y, z" for each pose, in Unity's frame. Numbers read back
/// to the same double. With `air`, also writes Air_Locations.txt; for a 3D raster, it includes the aerial poses that
/// are not in raster.poses. Throws OutputError.
SPAWNFIELD_API ThesisCounts write_thesis_locations(const std::filesystem::path& folder, const RasterResult& raster,
                                                   bool air, const Progress& progress = {});

/// The same for spawns, which are all valid locations. Invalid_Locations.txt is empty, because the list contains no
/// other locations; but thesis_stats() counts them.
SPAWNFIELD_API ThesisCounts write_thesis_locations(const std::filesystem::path& folder, const SpawnList& list);

/// Returns the text of Stats.txt, with a "Name: value" in each line: the settings, the number of poses for each class
/// and verdict, and the number of lines in each file.
SPAWNFIELD_API std::string thesis_stats(const std::vector<std::pair<std::string, std::string>>& settings,
                                        const VerdictCounts& counts, const ThesisCounts& written);

}  // namespace spawnfield
