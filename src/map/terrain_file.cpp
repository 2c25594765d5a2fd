#include "map/terrain_file.h"

#include "base/tiff.h"

#include <spawnfield/error.h>

namespace spawnfield {
namespace {

void set_tags(TIFF* tiff, const TerrainMap& terrain, const TerrainMap::Page& page, std::size_t number)
{
    TIFFSetField(tiff, TIFFTAG_IMAGEWIDTH, terrain.frame.cols);
    TIFFSetField(tiff, TIFFTAG_IMAGELENGTH, terrain.frame.rows);
    TIFFSetField(tiff, TIFFTAG_TILEWIDTH, TerrainMap::tile);
    TIFFSetField(tiff, TIFFTAG_TILELENGTH, TerrainMap::tile);
    TIFFSetField(tiff, TIFFTAG_BITSPERSAMPLE, 32);
    TIFFSetField(tiff, TIFFTAG_SAMPLESPERPIXEL, 1);
    TIFFSetField(tiff, TIFFTAG_SAMPLEFORMAT, SAMPLEFORMAT_IEEEFP);
    TIFFSetField(tiff, TIFFTAG_COMPRESSION, COMPRESSION_ADOBE_DEFLATE);
    TIFFSetField(tiff, TIFFTAG_PREDICTOR, PREDICTOR_FLOATINGPOINT);
    TIFFSetField(tiff, TIFFTAG_PHOTOMETRIC, PHOTOMETRIC_MINISBLACK);
    TIFFSetField(tiff, TIFFTAG_PLANARCONFIG, PLANARCONFIG_CONTIG);
    TIFFSetField(tiff, TIFFTAG_IMAGEDESCRIPTION, page.name.c_str());
    TIFFSetField(tiff, TIFFTAG_SUBFILETYPE, FILETYPE_PAGE);
    TIFFSetField(tiff, TIFFTAG_PAGENUMBER, int(number), int(terrain.pages.size()));
}

TerrainMap::Page read_page(TIFF* tiff, const std::filesystem::path& file, const TerrainMap& terrain)
{
    std::uint32_t width = 0, height = 0, tile_width = 0, tile_height = 0;
    std::uint16_t compression = 0, predictor = 0;
    const char* description = nullptr;
    TIFFGetField(tiff, TIFFTAG_IMAGEWIDTH, &width);
    TIFFGetField(tiff, TIFFTAG_IMAGELENGTH, &height);
    TIFFGetField(tiff, TIFFTAG_TILEWIDTH, &tile_width);
    TIFFGetField(tiff, TIFFTAG_TILELENGTH, &tile_height);
    if (int(width) != terrain.frame.cols || int(height) != terrain.frame.rows || tile_width != TerrainMap::tile ||
        tile_height != TerrainMap::tile || TIFFGetField(tiff, TIFFTAG_IMAGEDESCRIPTION, &description) != 1)
        throw FileError(file.string(), "has a page whose size is not that of the map's frame; bake the map again");
    TIFFGetFieldDefaulted(tiff, TIFFTAG_COMPRESSION, &compression);
    if (compression != COMPRESSION_ADOBE_DEFLATE || TIFFGetFieldDefaulted(tiff, TIFFTAG_PREDICTOR, &predictor) != 1 ||
        predictor != PREDICTOR_FLOATINGPOINT)
        throw FileError(file.string(), "has a page that is not deflated with predictor 3; bake the map again");
    TerrainMap::Page page{description, {}};
    const std::uint32_t tiles = TIFFNumberOfTiles(tiff);
    const auto cut_short = [&] {
        return FileError(file.string(), "is cut short in page " + page.name + "; bake the map again");
    };
    for (std::uint32_t t = 0; t < tiles; ++t) {
        const std::uint64_t size = TIFFGetStrileByteCount(tiff, t);
        if (size > std::filesystem::file_size(file)) throw cut_short();  // before memory is allocated for it
        std::string bytes(size, '\0');
        if (TIFFReadRawTile(tiff, t, bytes.data(), tmsize_t(bytes.size())) != tmsize_t(bytes.size())) throw cut_short();
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
            good = TIFFWriteRawTile(tiff.get(), std::uint32_t(t), bytes.data(), tmsize_t(bytes.size())) ==
                   tmsize_t(bytes.size());
        }
        good = good && TIFFWriteDirectory(tiff.get()) == 1;
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
    while (TIFFReadDirectory(tiff.get()) == 1);
    return terrain;
}

}  // namespace spawnfield
