#include "base/module.h"
#include "picture/drawing_module.h"

#include <spawnfield/heatmap.h>

namespace spawnfield {

void write_heatmap(const Map& map, const TerrainMap& terrain, const RasterResult& raster, const HeatmapOptions& options,
                   const std::filesystem::path& file)
{
    module_functions<drawing_module::Functions>().heatmap(map, terrain, raster, options, file);
}

void write_preview(const Map& map, const TerrainMap& terrain, const std::filesystem::path& file)
{
    module_functions<drawing_module::Functions>().preview(map, terrain, file);
}

}  // namespace spawnfield
