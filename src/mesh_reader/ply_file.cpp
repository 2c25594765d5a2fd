#include "mesh_reader/ply_file.h"

#include "base/number.h"
#include "base/text.h"

#include <spawnfield/error.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <optional>

namespace spawnfield {
namespace {

constexpr std::uint64_t most_rows = 2147483647;  // assimp's limit of vertices and faces
constexpr std::string_view line_ends = "\r\n";

enum class Format { Text, LittleEndian, BigEndian };

struct Type {
    enum class Kind { Signed, Unsigned, Float } kind = Kind::Signed;
    std::size_t bytes = 4;
};

struct Property {
    std::string name;
    Type type;
    std::optional<Type> count;  ///< type of the number of values; lists only
};

struct Element {
    std::string name;
    std::uint64_t rows = 0;
    std::size_t line = 0;  ///< of the header

    std::vector<Property> properties;
};

struct Header {
    Format format = Format::Text;
    std::vector<Element> elements;
    std::size_t size = 0, lines = 0;  ///< of the header, in bytes and lines
};

FileError line_fault(const std::string& file, std::size_t line, const std::string& what)
{
    return FileError(file, "line " + std::to_string(line) + ": " + what);
}

/// Returns a word as it appears in messages: in quotes, at most 40 characters, with ? for bytes that are not
/// printable ASCII.
std::string shown(std::string_view word)
{
    constexpr std::size_t most = 40;
    std::string text(word.substr(0, most));
    std::replace_if(
        text.begin(), text.end(), [](char c) { return c < ' ' || c > '~'; }, '?');
    return "\"" + text + (word.size() > most ? "…\"" : "\"");
}

std::vector<std::string_view> words_of(std::string_view line)
{
    constexpr std::string_view space = " \t\r\n";
    std::vector<std::string_view> words;
    for (std::size_t start = line.find_first_not_of(space); start != std::string_view::npos;
         start = line.find_first_not_of(space, start)) {
        const std::size_t end = std::min(line.find_first_of(space, start), line.size());
        words.push_back(line.substr(start, end - start));
        start = end;
    }
    return words;
}

std::optional<Type> type_of(std::string_view name)
{
    using enum Type::Kind;
    if (name == "char" || name == "int8") return Type{Signed, 1};
    if (name == "uchar" || name == "uint8") return Type{Unsigned, 1};
    if (name == "short" || name == "int16") return Type{Signed, 2};
    if (name == "ushort" || name == "uint16") return Type{Unsigned, 2};
    if (name == "int" || name == "int32") return Type{Signed, 4};
    if (name == "uint" || name == "uint32") return Type{Unsigned, 4};
    if (name == "float" || name == "float32") return Type{Float, 4};
    if (name == "double" || name == "float64") return Type{Float, 8};
    return {};
}

class HeaderReader {
public:
    HeaderReader(std::string_view bytes, const std::string& file) : bytes_(bytes), file_(file)
    {
        // The first line shows how all lines of the header end. The end of the last one would not: the byte after it
        // may be binary data that looks like \n.
        const std::size_t end = bytes.find_first_of(line_ends);
        if (end != std::string_view::npos && bytes[end] == '\r' && (end + 1 == bytes.size() || bytes[end + 1] != '\n'))
            line_end_ = '\r';
    }

    Header read()
    {
        next_line();
        bool has_format = false;
        for (;;) {
            const std::vector<std::string_view> words = words_of(next_line());
            if (words.empty() || words[0] == "comment" || words[0] == "obj_info") continue;
            if (words[0] == "end_header") break;
            if (words[0] == "format") {
                if (has_format) throw fault("a second format");
                read_format(words);
                has_format = true;
            } else if (words[0] == "element") {
                read_element(words);
            } else if (words[0] == "property") {
                read_property(words);
            } else {
                throw fault(shown(words[0]) +
                            " is not a keyword of a PLY header; known keywords: comment, obj_info, format, element, "
                            "property, end_header");
            }
        }
        if (!has_format) throw FileError(file_, "has no format in its header; is it a PLY file?");
        header_.size = position_;
        header_.lines = line_;
        return std::move(header_);
    }

private:
    std::string_view next_line()
    {
        const std::size_t end = bytes_.find(line_end_, position_);
        if (end == std::string_view::npos)
            throw FileError(file_, "ends within its header, before end_header; is it cut short?");
        const std::string_view line = bytes_.substr(position_, end - position_);
        position_ = end + 1;
        ++line_;
        return line;
    }

    FileError fault(const std::string& what) const { return line_fault(file_, line_, what); }

    void read_format(const std::vector<std::string_view>& words)
    {
        const std::string_view name = words.size() == 3 && words[2] == "1.0" ? words[1] : "";
        if (name == "ascii")
            header_.format = Format::Text;
        else if (name == "binary_little_endian")
            header_.format = Format::LittleEndian;
        else if (name == "binary_big_endian")
            header_.format = Format::BigEndian;
        else
            throw fault(
                "the format is unknown; known formats: ascii 1.0, binary_little_endian 1.0, binary_big_endian 1.0");
    }

    void read_element(const std::vector<std::string_view>& words)
    {
        if (words.size() != 3) throw fault("needs element NAME COUNT");
        Element element{std::string(words[1]), 0, line_, {}};
        double rows = 0;
        if (!parse_number(words[2], rows) || !(rows >= 0 && rows <= double(most_rows)) || rows != std::floor(rows))
            throw fault("element " + shown(words[1]) + " has the count " + shown(words[2]) +
                        ", needs a whole number of 0 .. " + std::to_string(most_rows));
        element.rows = std::uint64_t(rows);
        for (const Element& other : header_.elements)
            if (other.name == element.name) throw fault("a second element " + shown(element.name));
        header_.elements.push_back(std::move(element));
    }

    void read_property(const std::vector<std::string_view>& words)
    {
        const bool list = words.size() > 1 && words[1] == "list";
        if (words.size() != (list ? 5 : 3)) throw fault("needs property TYPE NAME or property list TYPE TYPE NAME");
        if (header_.elements.empty()) throw fault("a property without an element before it");
        const auto known = [&](std::string_view word) {
            const std::optional<Type> type = type_of(word);
            if (!type)
                throw fault("the type " + shown(word) +
                            " is unknown; known types: char, uchar, short, ushort, int, uint, float, double, int8, "
                            "uint8, int16, "
                            "uint16, int32, uint32, float32, float64");
            return *type;
        };
        Property property{std::string(words.back()), known(words[words.size() - 2]), {}};
        if (list) property.count = known(words[2]);
        if (list && property.count->kind == Type::Kind::Float)
            throw fault("a list is counted in " + shown(words[2]) + ", needs whole numbers");
        for (const Property& other : header_.elements.back().properties)
            if (other.name == property.name) throw fault("a second property " + shown(property.name));
        header_.elements.back().properties.push_back(std::move(property));
    }

    const std::string_view bytes_;
    const std::string& file_;
    char line_end_ = '\n';
    std::size_t position_ = 0, line_ = 0;
    Header header_;
};

std::string row_name(const Element& element, std::uint64_t row)
{
    return "element " + element.name + ", row " + std::to_string(row + 1) + " of " + std::to_string(element.rows);
}

/// Reads rows of numbers as text, one row per line. Skips blank lines between rows.
class TextRows {
public:
    TextRows(std::string_view bytes, const Header& header, const std::string& file)
        : bytes_(bytes), position_(header.size), line_(header.lines), file_(file)
    {
    }

    /// Returns the smallest number of bytes for these rows: a digit for each number and a byte between two numbers.
    static std::uint64_t least_bytes(const Element& element)
    {
        return 2 * element.rows * element.properties.size() - 1;
    }
    std::uint64_t remaining_bytes() const { return bytes_.size() - position_; }

    void begin(const Element& element, std::uint64_t row)
    {
        element_ = &element;
        row_number_ = row;
        do {
            if (position_ == bytes_.size())
                throw FileError(file_, "ends before " + row_name(element, row) + "; is it cut short?");
            take_line();
        } while (skip_space() == row_.size());
    }
    double next(const Type&)
    {
        column_ = skip_space();
        if (column_ == row_.size()) throw fault("ends before its last number; " + row_name(*element_, row_number_));
        const std::size_t end = std::min(row_.find_first_of(" \t", column_), row_.size());
        const std::string_view word = row_.substr(column_, end - column_);
        column_ = end;
        double value = 0;
        if (!parse_number(word, value))
            throw fault(shown(word) + " is not a number; " + row_name(*element_, row_number_));
        return value;
    }
    void end()
    {
        if (skip_space() != row_.size())
            throw fault(shown(row_.substr(skip_space())) + " comes after the last number of the row; " +
                        row_name(*element_, row_number_));
    }
    void finish()
    {
        while (position_ < bytes_.size()) {
            take_line();
            if (skip_space() != row_.size())
                throw fault("comes after the last row that the header declares; are the counts of its elements right?");
        }
    }
    FileError fault(const std::string& what) const { return line_fault(file_, line_, what); }

private:
    void take_line()
    {
        const std::size_t end = std::min(bytes_.find_first_of(line_ends, position_), bytes_.size());
        row_ = bytes_.substr(position_, end - position_);
        column_ = 0;
        position_ = std::min(end + 1, bytes_.size());
        if (end + 1 < bytes_.size() && bytes_[end] == '\r' && bytes_[end + 1] == '\n') ++position_;
        ++line_;
    }
    std::size_t skip_space() const { return std::min(row_.find_first_not_of(" \t", column_), row_.size()); }

    const std::string_view bytes_;
    std::size_t position_, line_, column_ = 0;
    const std::string& file_;
    std::string_view row_;
    const Element* element_ = nullptr;
    std::uint64_t row_number_ = 0;
};

/// Reads rows of numbers as bytes, little-endian or big-endian.
class BinaryRows {
public:
    BinaryRows(std::string_view bytes, const Header& header, const std::string& file)
        : bytes_(bytes), position_(header.size), swapped_(header.format == Format::BigEndian), file_(file)
    {
    }

    static std::uint64_t least_bytes(const Element& element)
    {
        std::uint64_t row = 0;
        for (const Property& property : element.properties)
            row += property.count ? property.count->bytes : property.type.bytes;
        return row * element.rows;
    }
    std::uint64_t remaining_bytes() const { return bytes_.size() - position_; }

    void begin(const Element& element, std::uint64_t row)
    {
        element_ = &element;
        row_number_ = row;
    }
    double next(const Type& type)
    {
        if (remaining_bytes() < type.bytes) throw fault("the file ends within it; is it cut short?");
        char value[8] = {};
        for (std::size_t i = 0; i < type.bytes; ++i) value[swapped_ ? type.bytes - 1 - i : i] = bytes_[position_ + i];
        position_ += type.bytes;
        const auto as = [&](auto number) {
            std::memcpy(&number, value, sizeof number);
            return double(number);
        };
        const bool is_signed = type.kind == Type::Kind::Signed;
        if (type.kind == Type::Kind::Float) return type.bytes == 4 ? as(0.0f) : as(0.0);
        if (type.bytes == 1) return is_signed ? as(std::int8_t{}) : as(std::uint8_t{});
        if (type.bytes == 2) return is_signed ? as(std::int16_t{}) : as(std::uint16_t{});
        return is_signed ? as(std::int32_t{}) : as(std::uint32_t{});
    }
    void end() {}
    void finish()
    {
        const std::string_view rest = bytes_.substr(position_);
        if (rest.find_first_not_of(" \t\r\n") != std::string_view::npos)
            throw FileError(
                file_, "has " + std::to_string(rest.size()) +
                           " bytes after the last row that the header declares; are the counts of its elements right?");
    }
    FileError fault(const std::string& what) const
    {
        return FileError(file_, row_name(*element_, row_number_) + ": " + what);
    }

private:
    const std::string_view bytes_;
    std::size_t position_;
    const bool swapped_;
    const std::string& file_;
    const Element* element_ = nullptr;
    std::uint64_t row_number_ = 0;
};

/// How the mesh uses a property.
enum class Use { None, X, Y, Z, Face, Strip };

Use use_of(const Element& element, const Property& property)
{
    const bool indices = property.count && (property.name == "vertex_indices" || property.name == "vertex_index");
    if (element.name == "face") return indices ? Use::Face : Use::None;
    if (element.name == "tristrips") return indices ? Use::Strip : Use::None;
    if (element.name != "vertex" || property.count) return Use::None;
    return property.name == "x" ? Use::X : property.name == "y" ? Use::Y : property.name == "z" ? Use::Z : Use::None;
}

const Element* find(const Header& header, std::string_view name)
{
    const auto found = std::find_if(header.elements.begin(), header.elements.end(),
                                    [&](const Element& e) { return e.name == name; });
    return found == header.elements.end() ? nullptr : &*found;
}

void check_uses(const Header& header, const std::string& file)
{
    const auto has = [](const Element& element, Use use) {
        return std::any_of(element.properties.begin(), element.properties.end(),
                           [&](const Property& p) { return use_of(element, p) == use; });
    };
    const Element *vertex = find(header, "vertex"), *face = find(header, "face"), *strips = find(header, "tristrips");
    if (vertex == nullptr) throw FileError(file, "has no element vertex in its header");
    for (const auto& [use, name] : {std::pair{Use::X, "x"}, std::pair{Use::Y, "y"}, std::pair{Use::Z, "z"}})
        if (!has(*vertex, use))
            throw line_fault(file, vertex->line, std::string("element vertex has no property ") + name);
    if (face == nullptr && strips == nullptr)
        throw FileError(
            file, "has no element face in its header: points without faces are not a surface; export it with faces");
    for (const auto& [element, use] : {std::pair{face, Use::Face}, std::pair{strips, Use::Strip}})
        if (element != nullptr && element->rows > 0 && !has(*element, use))
            throw line_fault(file, element->line,
                             "element " + element->name + " has no property list … vertex_indices");
}

template <class Rows>
class BodyReader {
public:
    BodyReader(const Header& header, Rows rows, const std::string& file)
        : header_(header), rows_(std::move(rows)), file_(file)
    {
    }

    PlyMesh read()
    {
        vertices_ = find(header_, "vertex")->rows;
        for (const Element& element : header_.elements)
            if (element.rows > 0) read_element(element);
        rows_.finish();
        return std::move(mesh_);
    }

private:
    void read_element(const Element& element)
    {
        if (element.properties.empty())
            throw line_fault(file_, element.line, "element " + shown(element.name) + " has no property");
        if (rows_.least_bytes(element) > rows_.remaining_bytes())
            throw line_fault(file_, element.line,
                             "element " + element.name + " has " + std::to_string(element.rows) +
                                 " rows, for which the file is too short (" + std::to_string(rows_.remaining_bytes()) +
                                 " bytes remaining, needs at least " + std::to_string(rows_.least_bytes(element)) +
                                 "); is it cut short?");
        std::vector<Use> uses;
        for (const Property& property : element.properties) uses.push_back(use_of(element, property));
        if (element.name == "vertex") mesh_.vertices.reserve(element.rows);
        if (element.name == "face") mesh_.face_ends.reserve(element.rows);
        for (std::uint64_t row = 0; row < element.rows; ++row) {
            rows_.begin(element, row);
            std::array<float, 3> point{};
            for (std::size_t p = 0; p < uses.size(); ++p) read_value(element.properties[p], uses[p], point);
            rows_.end();
            if (element.name == "vertex") mesh_.vertices.push_back(point);
        }
    }

    void read_value(const Property& property, Use use, std::array<float, 3>& point)
    {
        if (property.count) return read_list(property, use);
        const double value = rows_.next(property.type);
        if (use == Use::X) point[0] = float(value);
        if (use == Use::Y) point[1] = float(value);
        if (use == Use::Z) point[2] = float(value);
    }

    void read_list(const Property& property, Use use)
    {
        const double count = rows_.next(*property.count);
        if (!(count >= 0 && count <= double(most_rows)) || count != std::floor(count))
            throw rows_.fault("the list " + property.name + " has the count " + number(count) +
                              ", needs a whole number of 0 .. " + std::to_string(most_rows));
        if (use == Use::Face && count == 0) throw rows_.fault("a face has 0 corners, needs 3 or more");
        Strip strip;
        for (std::uint64_t i = 0; i < std::uint64_t(count); ++i) {
            const double value = rows_.next(property.type);
            if (use == Use::Strip && value == -1)
                strip = {};
            else if (use == Use::Strip)
                add_to_strip(strip, corner(value));
            else if (use == Use::Face)
                mesh_.corners.push_back(corner(value));
        }
        if (use == Use::Face) mesh_.face_ends.push_back(mesh_.corners.size());
    }

    std::uint32_t corner(double value) const
    {
        if (!(value >= 0 && value < double(vertices_)) || value != std::floor(value))
            throw rows_.fault("a face has the corner " + number(value) + ", needs one of the " +
                              std::to_string(vertices_) + " vertices, 0 .. " +
                              std::to_string(std::int64_t(vertices_) - 1));
        return std::uint32_t(value);
    }

    /// A triangle strip. Each corner forms a triangle with the two before it; every second triangle has the opposite
    /// winding.
    struct Strip {
        std::size_t length = 0;
        std::uint32_t before = 0, last = 0;
    };
    void add_to_strip(Strip& strip, std::uint32_t corner)
    {
        if (strip.length >= 2) {
            const bool turned = strip.length % 2 == 1;
            mesh_.corners.insert(mesh_.corners.end(),
                                 {turned ? strip.last : strip.before, turned ? strip.before : strip.last, corner});
            mesh_.face_ends.push_back(mesh_.corners.size());
        }
        strip = {strip.length + 1, strip.last, corner};
    }

    const Header& header_;
    Rows rows_;
    const std::string& file_;
    std::uint64_t vertices_ = 0;
    PlyMesh mesh_;
};

}  // namespace

bool is_ply(std::string_view bytes)
{
    const std::size_t end = bytes.find_first_of(line_ends);
    return end != std::string_view::npos && end < 64 && lower_case(trimmed(bytes.substr(0, end))) == "ply";
}

PlyMesh parse_ply(std::string_view bytes, const std::string& file)
{
    if (!is_ply(bytes)) throw FileError(file, "is not a PLY file: its first line is not \"ply\"");
    const Header header = HeaderReader(bytes, file).read();
    check_uses(header, file);
    if (header.format == Format::Text) return BodyReader(header, TextRows(bytes, header, file), file).read();
    return BodyReader(header, BinaryRows(bytes, header, file), file).read();
}

}  // namespace spawnfield
