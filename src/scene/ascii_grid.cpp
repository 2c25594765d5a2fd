#include "scene/ascii_grid.h"

#include "base/number.h"
#include "base/text.h"

#include <spawnfield/error.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>
#include <map>
#include <optional>

namespace spawnfield {
namespace {

constexpr std::array header_words{"ncols",     "nrows",    "xllcorner", "xllcenter", "yllcorner",
                                  "yllcenter", "cellsize", "dx",        "dy",        "nodata_value"};

bool is_space(char c) { return c == ' ' || (c >= '\t' && c <= '\r'); }

bool is_header_word(const std::string& word)
{
    return std::find(header_words.begin(), header_words.end(), word) != header_words.end();
}

/// Splits a text into words between white space, and counts the lines.
class Words {
public:
    explicit Words(std::string_view text) : text_(text) {}

    /// Returns the next word without taking it; empty at the end.
    std::string_view peek()
    {
        for (; position_ < text_.size() && is_space(text_[position_]); ++position_) line_ += text_[position_] == '\n';
        std::size_t end = position_;
        while (end < text_.size() && !is_space(text_[end])) ++end;
        return text_.substr(position_, end - position_);
    }
    std::string_view next()
    {
        const std::string_view word = peek();
        position_ += word.size();
        return word;
    }
    std::size_t line() const { return line_; }  ///< line of the last word, from 1

private:
    std::string_view text_;
    std::size_t position_ = 0, line_ = 1;
};

FileError fault(const std::string& file, const Words& words, const std::string& what)
{
    return FileError(file, "line " + std::to_string(words.line()) + ": " + what);
}

std::string quoted(std::string_view word)
{
    constexpr std::size_t most = 40;
    return word.empty() ? "the file's end"
                        : "\"" + std::string(word.substr(0, most)) + (word.size() > most ? "…\"" : "\"");
}

double next_number(Words& words, const std::string& file, const std::string& key)
{
    const std::string_view word = words.next();
    double value = 0;
    if (!parse_number(word, value) || !std::isfinite(value))
        throw fault(file, words, key + " is " + quoted(word) + ", needs a finite number");
    return value;
}

using Header = std::map<std::string, double>;

Header read_header(Words& words, const std::string& file)
{
    Header header;
    for (double value = 0;;) {
        const std::string_view word = words.peek();
        const std::string key = lower_case(word);
        if (!is_header_word(key)) {
            if (word.empty() || parse_number(word, value)) return header;
            throw fault(file, words,
                        quoted(word) +
                            " is neither a number nor a key of an ESRI ASCII grid's header; known keys: ncols, nrows, "
                            "xllcorner or "
                            "xllcenter, yllcorner or yllcenter, cellsize or dx and dy, NODATA_value");
        }
        words.next();
        if (header.contains(key)) throw fault(file, words, key + " is given twice");
        if (key == "nodata_value" && parse_number(words.peek(), value) && std::isnan(value)) {
            header[key] = value;
            words.next();
        } else {
            header[key] = next_number(words, file, key);
        }
    }
}

/// Returns the one of two keys that the header has, with its value. Throws FileError if it has none or both.
std::pair<std::string, double> one_of(const Header& header, const std::string& file, const std::string& first,
                                      const std::string& second)
{
    if (header.contains(first) && header.contains(second))
        throw FileError(file, "has " + first + " and " + second + ", needs one of them");
    for (const std::string& key : {first, second})
        if (const auto found = header.find(key); found != header.end()) return *found;
    throw FileError(file, "has neither " + first + " nor " + second + " in its header, needs one of them");
}

double positive(double value, const std::string& file, const std::string& key)
{
    if (!(value > 0)) throw FileError(file, key + " is " + number(value) + ", needs > 0");
    return value;
}

std::uint64_t count(const Header& header, const std::string& file, const std::string& key)
{
    const auto found = header.find(key);
    if (found == header.end()) throw FileError(file, "has no " + key + " in its header");
    const double value = found->second;
    constexpr double most = 2147483647;
    if (!(value >= 1) || value > most || value != std::floor(value))
        throw FileError(file, key + " is " + number(value) + ", needs a whole number of 1 or more");
    return std::uint64_t(value);
}

std::pair<double, double> cell_of(const Header& header, const std::string& file)
{
    if (!header.contains("dx") && !header.contains("dy")) {
        if (!header.contains("cellsize")) throw FileError(file, "has no cellsize in its header");
        const double side = positive(header.at("cellsize"), file, "cellsize");
        return {side, side};
    }
    if (header.contains("cellsize"))
        throw FileError(file, "has cellsize together with dx or dy, needs cellsize alone, or dx and dy");
    if (!header.contains("dx") || !header.contains("dy"))
        throw FileError(file, "has only one of dx and dy in its header, needs both, or cellsize");
    return {positive(header.at("dx"), file, "dx"), positive(header.at("dy"), file, "dy")};
}

/// Returns the coordinate of the centre of the first column (axis x) or of the lowest row (axis y).
double first_centre(const Header& header, const std::string& file, const std::string& axis, double cell)
{
    const auto [key, value] = one_of(header, file, axis + "llcorner", axis + "llcenter");
    return key.ends_with("corner") ? value + cell / 2 : value;
}

/// Returns a message about the first line that does not have the number of values of a row. Returns "" if there is
/// none, or if no line has that number, because then lines are not rows.
std::string uneven_line(Words words, const GreyImage& image)
{
    std::size_t line = 0, in_line = 0, full_lines = 0;
    std::string message;
    const auto end_line = [&] {
        if (in_line == std::size_t(image.cols))
            ++full_lines;
        else if (in_line > 0 && message.empty())
            message = "line " + std::to_string(line) + " has " + std::to_string(in_line) + " values, needs " +
                      std::to_string(image.cols) + " (ncols)";
        in_line = 0;
    };
    for (;;) {
        const std::string_view word = words.next();
        if (word.empty() || words.line() != line) end_line();
        if (word.empty()) return full_lines > 0 ? message : "";
        line = words.line();
        ++in_line;
    }
}

void read_values(Words words, const std::string& file, GreyImage& image)
{
    const Words start = words;
    const std::uint64_t wanted = std::uint64_t(image.rows) * std::uint64_t(image.cols);
    const auto wrong_count = [&](const std::string& found) {
        const std::string line = uneven_line(start, image);
        return FileError(file, (line.empty() ? "" : line + ": ") + "it has " + found + " values, needs " +
                                   std::to_string(wanted) + " (" + std::to_string(image.cols) + " x " +
                                   std::to_string(image.rows) + ")");
    };
    for (std::string_view word = words.next(); !word.empty(); word = words.next()) {
        double value = 0;
        if (!parse_number(word, value)) throw fault(file, words, quoted(word) + " is not a number");
        if (image.pixels.size() == wanted) throw wrong_count("more than " + std::to_string(wanted));
        image.pixels.push_back(value);
    }
    if (image.pixels.size() < wanted) throw wrong_count(std::to_string(image.pixels.size()));
}

}  // namespace

bool is_ascii_grid(std::string_view start)
{
    const std::string word = lower_case(Words(start).peek());
    return is_header_word(word);
}

AsciiGrid parse_ascii_grid(std::string_view text, const std::string& file, std::uint64_t most)
{
    Words words(text);
    const Header header = read_header(words, file);
    const std::uint64_t cols = count(header, file, "ncols"), rows = count(header, file, "nrows");
    if (rows > most / cols)
        throw FileError(file,
                        "has " + std::to_string(cols) + " x " + std::to_string(rows) + " cells, needs at most " +
                            std::to_string(most) +
                            "; make it coarser with gdalwarp -tr, or extract a part with gdal_translate -projwin");
    const auto [dx, dy] = cell_of(header, file);
    AsciiGrid grid;
    grid.frame.dx = dx;
    grid.frame.dy = dy;
    grid.frame.x = first_centre(header, file, "x", dx);
    grid.frame.y = first_centre(header, file, "y", dy) + double(rows - 1) * dy;
    if (const auto found = header.find("nodata_value"); found != header.end()) grid.no_data = found->second;
    grid.image.rows = int(rows);
    grid.image.cols = int(cols);
    read_values(words, file, grid.image);
    return grid;
}

}  // namespace spawnfield
