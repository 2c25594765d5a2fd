#pragma once

#include <optional>
#include <string>
#include <vector>

namespace spawnfield {

/// The properties of a coordinate reference system that decide how its numbers are read.
struct CoordinateSystem {
    enum class Kind {
        Vertical,    ///< no x and y, only heights
        Projected,   ///< x and y are lengths on a plane
        Geographic,  ///< longitude and latitude
        Geocentric   ///< x, y and z, measured from the Earth's centre
    };
    std::string name;  ///< as in the EPSG register or in the file; printable ASCII only
    Kind kind = Kind::Vertical;
    double unit = 1;  ///< m per unit of x and y; only for Projected
    /// m per unit of height, < 0 if it counts downwards (depths); empty: no heights.
    std::optional<double> height_unit;
};

/// Returns what PROJ knows about a definition: "EPSG:2263", or WKT text of any kind (also ESRI's .prj). Empty if PROJ
/// does not know it, if it is not a coordinate system, or if x and y are lengths without a common unit.
///
/// PROJ is used by a module of its own (src/crs), which is loaded at the first call: PROJ needs libcurl and SQLite, and
/// loading these would make every start of a program 30 ms longer. Throws std::runtime_error if the module cannot be
/// loaded or PROJ finds no database.
std::optional<CoordinateSystem> coordinate_system(const std::string& definition);

/// Adds a notice that the numbers named `what` ("heights") were converted to metres. Adds nothing if the unit is 1 m.
void add_unit_notice(const std::string& file, const std::string& what, double unit, std::vector<std::string>& notices);

/// Adds the same notice for heights. If `unit` is negative, also adds a notice that they are depths; it names
/// `source`: the entry of the file, or the coordinate system, that gives the unit.
void add_height_unit_notice(const std::string& file, double unit, const std::string& source,
                            std::vector<std::string>& notices);

/// Throws FileError for a file whose coordinates are not lengths on a plane. `name` ("EPSG:4326") may be empty.
[[noreturn]] void refuse_unprojected(const std::string& file, bool is_geocentric, const std::string& name);

namespace crs_module {

/// Does the work of coordinate_system(), inside the module.
std::optional<CoordinateSystem> find_system(const std::string& definition);

/// The functions that the module exports.
struct Functions {
    static constexpr const char *module = "crs", *failure = "coordinate systems cannot be looked up";
    decltype(&find_system) find;
};

}  // namespace crs_module

}  // namespace spawnfield
