#include "map/terrain_file.h"

#include "base/tiff.h"

#include <spawnfield/error.h>

namespace spawnfield {
namespace {

void set_tags(TIFF* tiff, const TerrainMap& terrain, const TerrainMap::Page& page, std::size_t number)
{
    libtiff().set_field(tiff, TIFFTAG_IMAGEWIDTH, terrain.frame.cols);
    libtiff().set_field(tiff, TIFFTAG_IMAGELENGTH, terrain.frame.rows);
    libtiff().set_field(tiff, TIFFTAG_TILEWIDTH, TerrainMap::tile);
    libtiff().set_field(tiff, TIFFTAG_TILELENGTH, TerrainMap::tile);
    libtiff().set_field(tiff, TIFFTAG_BITSPERSAMPLE, 32);
    libtiff().set_field(tiff, TIFFTAG_SAMPLESPERPIXEL, 1);
    libtiff().set_field(tiff, TIFFTAG_SAMPLEFORMAT, SAMPLEFORMAT_IEEEFP);
    libtiff().set_field(tiff, TIFFTAG_COMPRESSION, COMPRESSION_ADOBE_DEFLATE);
    libtiff().set_field(tiff, TIFFTAG_PREDICTOR, PREDICTOR_FLOATINGPOINT);
    libtiff().set_field(tiff, TIFFTAG_PHOTOMETRIC, PHOTOMETRIC_MINISBLACK);
    libtiff().set_field(tiff, TIFFTAG_PLANARCONFIG, PLANARCONFIG_CONTIG);
    libtiff().set_field(tiff, TIFFTAG_IMAGEDESCRIPTION, page.name.c_str());
    libtiff().set_field(tiff, TIFFTAG_SUBFILETYPE, FILETYPE_PAGE);
    libtiff().set_field(tiff, TIFFTAG_PAGENUMBER, int(number), int(terrain.pages.size()));
}

TerrainMap::Page read_page(TIFF* tiff, const std::filesystem::path& file, const TerrainMap& terrain)
{
    std::uint32_t width = 0, height = 0, tile_width = 0, tile_height = 0;
    std::uint16_t compression = 0, predictor = 0;
    const char* description = nullptr;
    libtiff().get_field(tiff, TIFFTAG_IMAGEWIDTH, &width);
    libtiff().get_field(tiff, TIFFTAG_IMAGELENGTH, &height);
    libtiff().get_field(tiff, TIFFTAG_TILEWIDTH, &tile_width);
    libtiff().get_field(tiff, TIFFTAG_TILELENGTH, &tile_height);
    if (int(width) != terrain.frame.cols || int(height) != terrain.frame.rows || tile_width != TerrainMap::tile ||
        tile_height != TerrainMap::tile || libtiff().get_field(tiff, TIFFTAG_IMAGEDESCRIPTION, &description) != 1)
        throw FileError(file.string(), "has a page whose size is not that of the map's frame; bake the map again");
    libtiff().get_field_defaulted(tiff, TIFFTAG_COMPRESSION, &compression);
    if (compression != COMPRESSION_ADOBE_DEFLATE ||
        libtiff().get_field_defaulted(tiff, TIFFTAG_PREDICTOR, &predictor) != 1 || predictor != PREDICTOR_FLOATINGPOINT)
        throw FileError(file.string(), "has a page that is not deflated with predictor 3; bake the map again");
    TerrainMap::Page page{description, {}};
    const std::uint32_t tiles = libtiff().number_of_tiles(tiff);
    const auto cut_short = [&] {
        return FileError(file.string(), "is cut short in page " + page.name + "; bake the map again");
    };
    for (std::uint32_t t = 0; t < tiles; ++t) {
        const std::uint64_t size = libtiff().get_strile_byte_count(tiff, t);
        if (size > std::filesystem::file_size(file)) throw cut_short();  // before memory is allocated for it
        std::string bytes(size, '\0');
        if (libtiff().read_raw_tile(tiff, t, bytes.data(), tmsize_t(bytes.size())) != tmsize_t(bytes.size()))
            throw cut_short();
        page.tiles.push_back(std::move(bytes));
    }
    return page;
}

}  // namespace

void write_terrain(const std::filesystem::path& file, const TerrainMap& terrain)
{
    const Tiff tiff = open_tiff(file, "w8");  // BigTIFF: a map may exceed 4 GB
    bool good = tiff != nullptr;
    for (std::size_t p = 0; good && p < terrain.pages.size(); ++p) {
        const TerrainMap::Page& page = terrain.pages[p];
        set_tags(tiff.get(), terrain, page, p);
        for (std::size_t t = 0; good && t < page.tiles.size(); ++t) {
            std::string bytes = page.tiles[t];
            good = libtiff().write_raw_tile(tiff.get(), std::uint32_t(t), bytes.data(), tmsize_t(bytes.size())) ==
                   tmsize_t(bytes.size());
        }
        good = good && libtiff().write_directory(tiff.get()) == 1;
    }
    if (!good) throw OutputError(file.string(), "cannot be written; is there space?");
}

TerrainMap read_terrain_file(const std::filesystem::path& file, const GridFrame& frame)
{
    const Tiff tiff = open_tiff(file, "r");
    if (!tiff) throw FileError(file.string(), "is missing or is not a TIFF file; bake the map again");
    TerrainMap terrain;
    terrain.frame = frame;
    do terrain.pages.push_back(read_page(tiff.get(), file, terrain));
    while (libtiff().read_directory(tiff.get()) == 1);
    return terrain;
}

}  // namespace spawnfield
