#include "base/coordinate_system.h"
#include "base/module.h"

#include <proj.h>

#include <memory>
#include <stdexcept>

namespace spawnfield {
namespace {

struct Closer {
    void operator()(PJ_CONTEXT* context) const { proj_context_destroy(context); }
    void operator()(PJ* object) const { proj_destroy(object); }
};
using Context = std::unique_ptr<PJ_CONTEXT, Closer>;
using Object = std::unique_ptr<PJ, Closer>;

Context open_context()
{
    Context context(proj_context_create());
    if (!context) throw std::runtime_error("coordinate systems cannot be looked up: PROJ cannot create a context");
    proj_log_level(context.get(), PJ_LOG_NONE);
    proj_context_set_enable_network(context.get(), 0);
    if (proj_context_get_database_path(context.get()) == nullptr)  // also null for a database of another PROJ version
        throw std::runtime_error(
            "coordinate systems cannot be looked up: PROJ " + std::string(proj_info().version) +
            " does not find a proj.db for its version; install the package proj-data, or check PROJ_LIB and PROJ_DATA");
    return context;
}

/// Returns the metres per unit of axis number `index`, < 0 if the axis points down; empty if there is no such axis or
/// if PROJ does not know its unit. The axis must measure a length, not an angle.
std::optional<double> axis_unit(PJ_CONTEXT* context, const PJ* axes, int index)
{
    const char* direction = nullptr;
    double factor = 0;
    if (index >= proj_cs_get_axis_count(context, axes)) return std::nullopt;
    if (proj_cs_get_axis_info(context, axes, index, nullptr, nullptr, &direction, &factor, nullptr, nullptr, nullptr) !=
        1)
        return std::nullopt;
    if (!(factor > 0) || direction == nullptr) return std::nullopt;
    return std::string(direction) == "down" ? -factor : factor;
}

std::optional<CoordinateSystem> describe(PJ_CONTEXT* context, const PJ* system);

/// Returns the horizontal system of the two, with the unit of the vertical one if that is known.
std::optional<CoordinateSystem> describe_compound(PJ_CONTEXT* context, const PJ* system)
{
    const Object horizontal(proj_crs_get_sub_crs(context, system, 0)),
        vertical(proj_crs_get_sub_crs(context, system, 1));
    if (!horizontal || !vertical) return std::nullopt;
    std::optional<CoordinateSystem> found = describe(context, horizontal.get());
    const std::optional<CoordinateSystem> heights = describe(context, vertical.get());
    if (found && heights) found->height_unit = heights->height_unit;
    return found;
}

std::optional<CoordinateSystem> describe_single(PJ_CONTEXT* context, const PJ* system, CoordinateSystem::Kind kind)
{
    using Kind = CoordinateSystem::Kind;
    CoordinateSystem found;
    found.kind = kind;
    const Object axes(proj_crs_get_coordinate_system(context, system));
    if (!axes) return std::nullopt;
    if (kind == Kind::Vertical) found.height_unit = axis_unit(context, axes.get(), 0);
    if (kind == Kind::Projected || kind == Kind::Geographic) found.height_unit = axis_unit(context, axes.get(), 2);
    if (kind == Kind::Projected) {
        const std::optional<double> x = axis_unit(context, axes.get(), 0), y = axis_unit(context, axes.get(), 1);
        if (!x || x != y) return std::nullopt;
        found.unit = *x;
    }
    return found;
}

std::optional<CoordinateSystem> describe(PJ_CONTEXT* context, const PJ* system)
{
    using Kind = CoordinateSystem::Kind;
    switch (proj_get_type(system)) {
    case PJ_TYPE_BOUND_CRS: {
        const Object inner(proj_get_source_crs(context, system));
        return inner ? describe(context, inner.get()) : std::nullopt;
    }
    case PJ_TYPE_COMPOUND_CRS: return describe_compound(context, system);
    case PJ_TYPE_VERTICAL_CRS: return describe_single(context, system, Kind::Vertical);
    case PJ_TYPE_GEOGRAPHIC_2D_CRS:
    case PJ_TYPE_GEOGRAPHIC_3D_CRS: return describe_single(context, system, Kind::Geographic);
    case PJ_TYPE_GEOCENTRIC_CRS: return describe_single(context, system, Kind::Geocentric);
    case PJ_TYPE_PROJECTED_CRS:
    case PJ_TYPE_ENGINEERING_CRS:
    case PJ_TYPE_OTHER_CRS: return describe_single(context, system, Kind::Projected);
    default: return std::nullopt;
    }
}

}  // namespace

std::optional<CoordinateSystem> crs_module::find_system(const std::string& definition)
{
    const std::string epsg = "EPSG:";
    const Context context = open_context();
    const Object system(definition.starts_with(epsg)
                            ? proj_create_from_database(context.get(), "EPSG", definition.c_str() + epsg.size(),
                                                        PJ_CATEGORY_CRS, 0, nullptr)
                            : proj_create_from_wkt(context.get(), definition.c_str(), nullptr, nullptr, nullptr));
    if (!system) return std::nullopt;
    std::optional<CoordinateSystem> found = describe(context.get(), system.get());
    const char* const name = proj_get_name(system.get());
    if (found && name != nullptr) found->name = name;
    if (found) std::erase_if(found->name, [](unsigned char c) { return c < ' ' || c > '~'; });
    return found;
}

}  // namespace spawnfield

SPAWNFIELD_MODULE(crs, &spawnfield::crs_module::find_system);
