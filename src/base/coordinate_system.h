#pragma once

#include <optional>
#include <string>
#include <vector>

namespace spawnfield {

/// What a coordinate reference system says of the numbers in it.
struct CoordinateSystem {
    enum class Place {
        None,     ///< it has no x and y: heights alone
        Plane,    ///< x and y are lengths
        Degrees,  ///< longitude and latitude
        Globe     ///< x, y and z from the Earth's centre
    };
    std::string name;  ///< in the register's or the file's own words, printable ASCII
    Place place = Place::None;
    double unit = 1;                    ///< m, of x and y on a plane
    std::optional<double> height_unit;  ///< m; < 0 where it counts downwards (depths); nothing: it has no heights
};

/// By PROJ, of "EPSG:2263", or of a WKT of any kind (ESRI's .prj too); nothing if PROJ does not know it, or it is none.
///
/// What asks PROJ is a module of its own (src/crs), loaded at the first call: PROJ brings libcurl and SQLite with it,
/// 30 ms that every start of a program would pay. Throws std::runtime_error if it cannot be loaded, or has no database.
std::optional<CoordinateSystem> coordinate_system(const std::string& definition);

/// Adds the notice that `what` ("heights") was converted; none for metres.
void tell_unit(const std::string& file, const std::string& what, double unit, std::vector<std::string>& notices);

/// The same for heights; and if `unit` is < 0, that by `place`, which says so, they are depths.
void tell_height_unit(const std::string& file, double unit, const std::string& place,
                      std::vector<std::string>& notices);

/// Throws the FileError of a file in coordinates that are no lengths on a plane; `name` ("EPSG:4326") may be empty.
[[noreturn]] void refuse_globe(const std::string& file, bool is_geocentric, const std::string& name);

namespace crs_module {

std::optional<CoordinateSystem> find_system(const std::string& definition);

/// What the module's only symbol points to.
struct Functions {
    decltype(&find_system) find;
};
inline constexpr const char* symbol = "spawnfield_crs_functions";

}  // namespace crs_module

}  // namespace spawnfield
