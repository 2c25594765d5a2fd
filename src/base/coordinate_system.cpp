#include "base/coordinate_system.h"

#include "base/module.h"
#include "base/number.h"

#include <spawnfield/error.h>

#include <cmath>

namespace spawnfield {

std::optional<CoordinateSystem> coordinate_system(const std::string& definition)
{
    return module_functions<crs_module::Functions>().find(definition);
}

void add_unit_notice(const std::string& file, const std::string& what, double unit, std::vector<std::string>& notices)
{
    if (std::abs(unit) != 1)
        notices.push_back(file + ": " + what + " are in units of " + number(std::abs(unit)) +
                          " m and were converted to metres");
}

void add_height_unit_notice(const std::string& file, double unit, const std::string& source,
                            std::vector<std::string>& notices)
{
    add_unit_notice(file, "heights", unit, notices);
    if (unit < 0)
        notices.push_back(file + ": its values are depths (" + source +
                          " counts downwards); heights are their negatives");
}

void refuse_unprojected(const std::string& file, bool is_geocentric, const std::string& name)
{
    throw FileError(file, std::string("has coordinates ") +
                              (is_geocentric ? "from the Earth's centre (geocentric" : "in degrees (geographic") +
                              (name.empty() ? "" : ", " + name) +
                              "), needs metres; reproject it: gdalwarp -t_srs EPSG:CODE, where CODE is a projection in "
                              "metres, such as that of the UTM zone");
}

}  // namespace spawnfield
