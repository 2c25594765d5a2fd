#pragma once

#include <spawnfield/export.h>
#include <spawnfield/region.h>

#include <filesystem>

namespace spawnfield {

/// The cells of a nav2 map that become the region: free cells, or occupied cells as in nav2's keepout filter.
enum class MapCells { Free, Occupied };

/// Reads a region from a GeoJSON, CSV or nav2 file. The extension of the name decides: .json and .geojson are GeoJSON,
/// .yaml and .yml are the map.yaml of a nav2 map, all others are CSV. GeoJSON may contain Polygon, MultiPolygon,
/// Feature, FeatureCollection and GeometryCollection; its coordinates are metres of the map. CSV has x,y in a row for
/// each corner. A new polygon begins after an empty line, or when the value in a column `polygon` changes.
///
/// Throws FileError with line or element for rings that are not closed (GeoJSON), rings with fewer than 3 corners,
/// numbers that are not finite, and geometries without area.
SPAWNFIELD_API Region read_region(const std::filesystem::path& file, MapCells cells = MapCells::Free);

/// The same for the text of a GeoJSON or CSV file. It is GeoJSON if it starts with a brace. Messages use `name` as the
/// file's name.
SPAWNFIELD_API Region parse_region(const std::string& text, const std::string& name);

}  // namespace spawnfield
