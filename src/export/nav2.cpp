#include "base/number.h"
#include "base/text.h"

#include <spawnfield/error.h>
#include <spawnfield/map_export.h>
#include <spawnfield/output_file.h>

#include <yaml-cpp/yaml.h>

namespace spawnfield {
namespace {

constexpr std::uint8_t free_pixel = 254, unknown_pixel = 205, occupied_pixel = 0;  // as map_saver writes them

std::uint8_t pixel_of(std::uint8_t verdict)
{
    if (verdict == VerdictImage::no_pose || Verdict(verdict) == Verdict::Outside) return unknown_pixel;
    return Verdict(verdict) == Verdict::Valid ? free_pixel : occupied_pixel;
}

std::string pgm_bytes(const VerdictImage& image)
{
    std::string bytes = "P5\n" + std::to_string(image.frame.cols) + " " + std::to_string(image.frame.rows) + "\n255\n";
    bytes.reserve(bytes.size() + image.verdicts.size());
    for (const std::uint8_t verdict : image.verdicts) bytes += char(pixel_of(verdict));
    return bytes;
}

std::string yaml_text(const GridFrame& frame, const std::string& image, const std::vector<std::string>& comment)
{
    std::string text;
    for (const std::string& line : comment) text += "# " + one_line(line) + "\n";
    YAML::Emitter name;
    name << image;
    text += std::string("image: ") + name.c_str() + "\nmode: trinary\nresolution: " + number(frame.cell) + "\n";
    text += "origin: [" + number(frame.x0) + ", " + number(frame.y0) + ", 0]\nnegate: 0\noccupied_thresh: 0.65\n";
    // map_server takes pixels whose occupancy is below free_thresh as free. The unknown pixel, 205, has the occupancy
    // 0.19608, so free_thresh must be lower. With 0.25, as in many files, unknown pixels would be free.
    return text + "free_thresh: 0.196\n";
}

}  // namespace

std::filesystem::path nav2_image_of(const std::filesystem::path& yaml)
{
    const std::string extension = yaml.extension().string();
    if (extension != ".yaml" && extension != ".yml")
        throw ArgumentError("nav2_image_of",
                            "the file's name is \"" + yaml.string() +
                                "\", needs the ending .yaml or .yml; the image gets the same name with .pgm");
    return std::filesystem::path(yaml).replace_extension(".pgm");
}

std::vector<std::string> write_nav2_map(const VerdictImage& image, const std::filesystem::path& yaml,
                                        const std::vector<std::string>& comment)
{
    const std::filesystem::path pgm = nav2_image_of(yaml);
    OutputFile pixels(pgm), text(yaml);
    pixels.write(pgm_bytes(image));
    text.write(yaml_text(image.frame, pgm.filename().string(), comment));
    OutputFile* const both[] = {&pixels, &text};
    return OutputFile::commit_together(both);
}

}  // namespace spawnfield
