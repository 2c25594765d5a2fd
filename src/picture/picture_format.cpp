#include <spawnfield/error.h>
#include <spawnfield/picture_format.h>

#include <algorithm>

namespace spawnfield {

const char* to_string(PictureFormat format)
{
    switch (format) {
    case PictureFormat::Svg: return "svg";
    case PictureFormat::Pdf: return "pdf";
    case PictureFormat::Png: break;
    }
    return "png";
}

PictureFormat picture_format(const std::filesystem::path& file)
{
    std::string ending = file.extension().string();
    std::transform(ending.begin(), ending.end(), ending.begin(),
                   [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
    for (const PictureFormat format : {PictureFormat::Png, PictureFormat::Svg, PictureFormat::Pdf})
        if (ending.empty() || ending.substr(1) == to_string(format)) return format;
    throw ArgumentError("picture_format", file.string() + " ends in " + file.extension().string() +
                                              ", but pictures are written as .png, .svg or .pdf; rename it");
}

}  // namespace spawnfield
