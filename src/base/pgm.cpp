#include "base/pgm.h"

#include "base/input_file.h"
#include "base/number.h"

#include <spawnfield/error.h>

#include <string>

namespace spawnfield {
namespace {

bool is_space(char c) { return c == ' ' || (c >= '\t' && c <= '\r'); }

class PgmReader {
public:
    PgmReader(std::string_view text, const std::string& file) : text_(text), file_(file) {}

    /// Returns the next whole number; skips white space and comments before it.
    std::uint32_t number(const std::string& what)
    {
        for (; position_ < text_.size() && (is_space(text_[position_]) || text_[position_] == '#'); ++position_)
            if (text_[position_] == '#') position_ = std::min(text_.find('\n', position_), text_.size() - 1);
        std::uint64_t value = 0;
        const std::size_t start = position_;
        for (; position_ < text_.size() && text_[position_] >= '0' && text_[position_] <= '9' && value < 1u << 31;
             ++position_)
            value = 10 * value + std::uint64_t(text_[position_] - '0');
        if (position_ == start || value >= 1u << 31)
            throw FileError(file_, "is cut short or a damaged PGM image: " + what + " is not a whole number");
        return std::uint32_t(value);
    }

    /// Skips one white space and returns the rest.
    std::string_view rest()
    {
        if (position_ < text_.size() && is_space(text_[position_])) ++position_;
        return text_.substr(position_);
    }

private:
    std::string_view text_;
    const std::string& file_;
    std::size_t position_ = 2;
};

std::uint32_t checked(std::uint32_t value, std::uint32_t most, const std::string& file, const std::string& what)
{
    if (value < 1 || value > most)
        throw FileError(file,
                        "has a " + what + " of " + std::to_string(value) + ", needs 1 to " + std::to_string(most));
    return value;
}

void read_text(PgmReader& reader, std::size_t count, std::vector<double>& pixels)
{
    for (std::size_t i = 0; i < count; ++i) pixels.push_back(reader.number("pixel " + std::to_string(i)));
}

void read_bytes(std::string_view bytes, std::size_t count, bool wide, std::vector<double>& pixels,
                const std::string& file)
{
    if (bytes.size() < count * (wide ? 2 : 1))
        throw FileError(file, "is cut short: it has " + std::to_string(bytes.size()) + " bytes of pixels, needs " +
                                  std::to_string(count * (wide ? 2 : 1)));
    const auto byte = [&](std::size_t i) { return std::uint8_t(bytes[i]); };
    for (std::size_t i = 0; i < count; ++i) pixels.push_back(wide ? byte(2 * i) * 256 + byte(2 * i + 1) : byte(i));
}

}  // namespace

bool is_pgm(std::string_view start) { return start.starts_with("P2") || start.starts_with("P5"); }

GreyImage read_pgm(const std::filesystem::path& path, std::uint64_t most)
{
    const std::string file = path.string(), text = read_file(path);
    if (!is_pgm(text)) throw FileError(file, "is not a PGM image (P2 or P5)");
    PgmReader reader(text, file);
    constexpr std::uint32_t most_side = 2147483647;
    const std::uint32_t cols = checked(reader.number("the width"), most_side, file, "width"),
                        rows = checked(reader.number("the height"), most_side, file, "height");
    if (std::uint64_t(rows) * cols > most)
        throw FileError(file, "has " + std::to_string(cols) + " x " + std::to_string(rows) + " pixels, needs at most " +
                                  std::to_string(most));
    const std::uint32_t largest = checked(reader.number("the largest value"), 65535, file, "largest value");
    GreyImage image{int(rows), int(cols), double(largest), {}};
    const std::size_t count = std::size_t(rows) * cols;
    if (text[1] == '2')
        read_text(reader, count, image.pixels);
    else
        read_bytes(reader.rest(), count, largest > 255, image.pixels, file);
    for (const double pixel : image.pixels)
        if (pixel > largest)
            throw FileError(file, "has a pixel of " + number(pixel) + ", needs at most its largest value " +
                                      std::to_string(largest));
    return image;
}

}  // namespace spawnfield
