#pragma once

#include <spawnfield/export.h>
#include <spawnfield/region.h>

#include <filesystem>

namespace spawnfield {

/// What of a nav2 map is the region: its free cells, or as its keepout filter has it the occupied ones.
enum class MapCells { Free, Occupied };

/// Reads GeoJSON (Polygon, MultiPolygon, Feature, FeatureCollection, GeometryCollection; coordinates are metres of the
/// map), CSV (x,y in a row for each corner; an empty line, or another value in a column `polygon`, begins the next), or
/// a nav2 map.yaml. By extension: .json, .geojson; .yaml, .yml; else CSV.
///
/// Throws FileError with line or element: rings that are not closed (GeoJSON), of fewer than 3 corners, numbers that
/// are not finite, geometries without area.
SPAWNFIELD_API Region read_region(const std::filesystem::path& file, MapCells cells = MapCells::Free);

/// The same for the text of a GeoJSON or CSV file; it is GeoJSON if it starts with a brace. `name` stands for the file
/// in messages.
SPAWNFIELD_API Region parse_region(const std::string& text, const std::string& name);

}  // namespace spawnfield
