#include "map/geometry_file.h"

#include "base/checksum.h"
#include "base/input_file.h"
#include "scene/elements.h"

#include <spawnfield/error.h>

#include <algorithm>
#include <bit>
#include <cstring>

namespace spawnfield {
namespace {

static_assert(std::endian::native == std::endian::little, "geometry.bin is little-endian; this machine needs a byte swap");

constexpr std::string_view magic = "SPAWNGEO";
constexpr std::uint32_t file_version = 1;
constexpr std::size_t alignment = 64;  // of sections, so that they can be mapped and read in place
constexpr std::size_t name_size = 16;
constexpr std::size_t head_size = 16;                     // magic, version, number of sections
constexpr std::size_t entry_size = name_size + 8 + 8 + 8;  // name, offset, size, xxh64

/// Appends plain values field by field: never a struct with padding.
class Writer {
public:
    template <class T>
    void put(T value)
    {
        static_assert(std::is_arithmetic_v<T>);
        bytes_.append(reinterpret_cast<const char*>(&value), sizeof value);
    }
    void put(const Vec3& v)
    {
        for (const double x : v) put(x);
    }
    void put(const std::string& text)
    {
        put(std::uint32_t(text.size()));
        bytes_ += text;
    }
    template <class T>
    void put_array(const std::vector<T>& values)
    {
        put(std::uint64_t(values.size()));
        bytes_.append(reinterpret_cast<const char*>(values.data()), values.size() * sizeof(T));
    }
    std::string take() { return std::move(bytes_); }

private:
    std::string bytes_;
};

/// Reads what Writer wrote; throws std::out_of_range past the end.
class Reader {
public:
    explicit Reader(std::string_view bytes) : rest_(bytes) {}

    template <class T>
    T get()
    {
        T value;
        std::memcpy(&value, take(sizeof value), sizeof value);
        return value;
    }
    Vec3 get_vector()
    {
        const double x = get<double>(), y = get<double>(), z = get<double>();
        return {x, y, z};
    }
    std::string get_text()
    {
        const auto size = get<std::uint32_t>();
        return std::string(take(size), size);
    }
    template <class T>
    std::vector<T> get_array()
    {
        const auto count = get<std::uint64_t>();
        if (count > rest_.size() / sizeof(T)) throw std::out_of_range("array");
        std::vector<T> values(count);
        if (count > 0) std::memcpy(static_cast<void*>(values.data()), take(count * sizeof(T)), count * sizeof(T));
        return values;
    }
    /// Number of records that follow; each has at least a byte.
    std::uint32_t get_count()
    {
        const auto count = get<std::uint32_t>();
        if (count > rest_.size()) throw std::out_of_range("count");
        return count;
    }

private:
    const char* take(std::size_t size)
    {
        if (size > rest_.size()) throw std::out_of_range("value");
        const char* const at = rest_.data();
        rest_.remove_prefix(size);
        return at;
    }
    std::string_view rest_;
};

using Sections = std::vector<std::pair<std::string, std::string>>;

std::string write_parts(const Scene& scene)
{
    Writer out;
    out.put(scene.name);
    out.put(std::uint32_t(scene.parts.size()));
    for (const Part& part : scene.parts) {
        out.put(part.name);
        out.put(part.kind);
        out.put(std::uint8_t(part.label));
        for (const std::uint32_t n : {part.solid_pieces, part.sheet_pieces, part.open_edges, part.triangles}) out.put(n);
    }
    return out.take();
}

void read_parts(Reader in, Scene& scene)
{
    scene.name = in.get_text();
    scene.parts.resize(in.get_count());
    for (Part& part : scene.parts) {
        part.name = in.get_text();
        part.kind = in.get_text();
        part.label = Label(in.get<std::uint8_t>());
        for (std::uint32_t* n : {&part.solid_pieces, &part.sheet_pieces, &part.open_edges, &part.triangles})
            *n = in.get<std::uint32_t>();
    }
}

std::string write_pieces(const Scene& scene)
{
    Writer out;
    out.put(std::uint32_t(scene.pieces.size()));
    for (const Piece& piece : scene.pieces) {
        for (const std::uint32_t n : {piece.part, piece.first_triangle, piece.triangle_count}) out.put(n);
        out.put(std::uint8_t(piece.solid));
        out.put(std::uint8_t(piece.sides_up));
        out.put(piece.bottom);
    }
    return out.take();
}

void read_pieces(Reader in, Scene& scene)
{
    scene.pieces.resize(in.get_count());
    for (Piece& piece : scene.pieces) {
        for (std::uint32_t* n : {&piece.part, &piece.first_triangle, &piece.triangle_count}) *n = in.get<std::uint32_t>();
        piece.solid = in.get<std::uint8_t>() != 0;
        piece.sides_up = in.get<std::uint8_t>() != 0;
        piece.bottom = in.get<double>();
    }
}

std::string write_primitives(const Scene& scene)
{
    Writer out;
    out.put(std::uint32_t(scene.primitives.size()));
    for (const Primitive& primitive : scene.primitives) {
        out.put(std::uint8_t(primitive.shape.kind));
        out.put(std::uint8_t(primitive.label));
        out.put(primitive.part);
        out.put(primitive.shape.size);
        out.put(primitive.shape.pose.position);
        for (int col = 0; col < 3; ++col) out.put(Vec3(primitive.shape.pose.rotation.col(col)));
    }
    return out.take();
}

void read_primitives(Reader in, Scene& scene)
{
    scene.primitives.resize(in.get_count());
    for (Primitive& primitive : scene.primitives) {
        primitive.shape.kind = ShapeKind(in.get<std::uint8_t>());
        primitive.label = Label(in.get<std::uint8_t>());
        primitive.part = in.get<std::uint32_t>();
        primitive.shape.size = in.get_vector();
        primitive.shape.pose.position = in.get_vector();
        for (int col = 0; col < 3; ++col) primitive.shape.pose.rotation.col(col) = in.get_vector();
    }
}

std::string write_index(const ColumnIndex& index)
{
    Writer out;
    out.put(index.x0);
    out.put(index.y0);
    out.put(std::uint32_t(index.levels.size()));
    for (const ColumnIndex::Level& level : index.levels) {
        out.put(level.cell);
        out.put(level.cols);
        out.put(level.rows);
        out.put_array(level.offsets);
        out.put_array(level.elements);
    }
    return out.take();
}

void read_index(Reader in, ColumnIndex& index)
{
    index.x0 = in.get<double>();
    index.y0 = in.get<double>();
    index.levels.resize(in.get_count());
    for (ColumnIndex::Level& level : index.levels) {
        level.cell = in.get<double>();
        level.cols = in.get<std::uint32_t>();
        level.rows = in.get<std::uint32_t>();
        level.offsets = in.get_array<std::uint32_t>();
        level.elements = in.get_array<std::uint32_t>();
    }
}

template <class T>
std::string array_section(const std::vector<T>& values)
{
    Writer out;
    out.put_array(values);
    return out.take();
}

std::string_view section(const std::filesystem::path& file, std::string_view bytes, const std::string& name)
{
    Reader head(bytes.substr(magic.size() + 4));
    const auto count = head.get<std::uint32_t>();
    for (std::uint32_t s = 0; s < count; ++s) {
        Reader entry(bytes.substr(head_size + s * entry_size + name_size));
        const char* const text = bytes.data() + head_size + s * entry_size;
        const auto offset = entry.get<std::uint64_t>(), size = entry.get<std::uint64_t>(), sum = entry.get<std::uint64_t>();
        if (std::string(text, strnlen(text, name_size)) != name) continue;
        if (offset > bytes.size() || size > bytes.size() - offset) throw FileError(file.string(), "is cut short at section " + name);
        const std::string_view found = bytes.substr(offset, size);
        if (XXH64(found.data(), found.size(), 0) != sum)
            throw FileError(file.string(), "section " + name + " is damaged (its checksum differs); bake the map again");
        return found;
    }
    throw FileError(file.string(), "has no section " + name + "; bake the map again");
}

/// Every index in its range: a file that passes its checksums may still have been made by someone else's hands.
bool is_consistent(const Scene& scene, const ColumnIndex& index)
{
    const auto below = [](const auto& values, std::size_t limit) {
        return std::all_of(values.begin(), values.end(), [&](std::uint32_t v) { return v < limit; });
    };
    const std::size_t triangles = scene.triangles.size();
    if (scene.triangle_labels.size() != triangles || scene.triangle_pieces.size() != triangles) return false;
    if (!below(scene.triangle_pieces, scene.pieces.size())) return false;
    for (const Triangle& triangle : scene.triangles)
        if (!below(triangle, scene.vertices.size())) return false;
    const auto is_kept = [](Label label) { return label < Label::Ignore; };
    if (!std::all_of(scene.triangle_labels.begin(), scene.triangle_labels.end(), is_kept)) return false;
    for (const Part& part : scene.parts)
        if (part.label > Label::Ignore) return false;
    for (const Piece& piece : scene.pieces)
        if (piece.part >= scene.parts.size() || std::size_t(piece.first_triangle) + piece.triangle_count > triangles) return false;
    for (const Primitive& primitive : scene.primitives)
        if (primitive.part >= scene.parts.size() || primitive.shape.kind > ShapeKind::Capsule || !is_kept(primitive.label)) return false;
    for (const ColumnIndex::Level& level : index.levels) {
        const std::size_t bins = std::size_t(level.cols) * level.rows;
        if (!(level.cell > 0) || bins == 0 || level.offsets.size() != bins + 1 || level.offsets.back() != level.elements.size())
            return false;
        if (!std::is_sorted(level.offsets.begin(), level.offsets.end()) || !below(level.elements, element_count(scene))) return false;
    }
    return true;
}

}  // namespace

std::string geometry_bytes(const Scene& scene, const ColumnIndex& index)
{
    const Sections sections = {{"parts", write_parts(scene)},
                               {"vertices", array_section(scene.vertices)},
                               {"triangles", array_section(scene.triangles)},
                               {"labels", array_section(scene.triangle_labels)},
                               {"triangle_pieces", array_section(scene.triangle_pieces)},
                               {"pieces", write_pieces(scene)},
                               {"primitives", write_primitives(scene)},
                               {"index", write_index(index)}};
    const auto aligned = [](std::size_t offset) { return (offset + alignment - 1) / alignment * alignment; };
    std::string out(magic);
    Writer head;
    head.put(file_version);
    head.put(std::uint32_t(sections.size()));
    std::size_t offset = aligned(head_size + sections.size() * entry_size);
    std::string entries = head.take();
    for (const auto& [name, bytes] : sections) {
        Writer entry;
        entry.put(std::uint64_t(offset));
        entry.put(std::uint64_t(bytes.size()));
        entry.put(std::uint64_t(XXH64(bytes.data(), bytes.size(), 0)));
        std::string padded = name;
        padded.resize(name_size, '\0');
        entries += padded + entry.take();
        offset = aligned(offset + bytes.size());
    }
    out += entries;
    for (const auto& [name, bytes] : sections) {
        out.resize(aligned(out.size()), '\0');
        out += bytes;
    }
    return out;
}

void read_geometry(const std::filesystem::path& file, Scene& scene, ColumnIndex& index)
{
    const std::string bytes = read_file(file);
    const std::string_view view = bytes;
    if (view.size() < head_size || view.substr(0, magic.size()) != magic) throw FileError(file.string(), "is no geometry file of a map");
    if (const auto found = Reader(view.substr(magic.size())).get<std::uint32_t>(); found != file_version)
        throw FileError(file.string(), "has format version " + std::to_string(found) + ", this program reads " + std::to_string(file_version));
    try {
        const auto open = [&](const char* name) { return Reader(section(file, view, name)); };
        read_parts(open("parts"), scene);
        scene.vertices = open("vertices").get_array<Vec3>();
        scene.triangles = open("triangles").get_array<Triangle>();
        scene.triangle_labels = open("labels").get_array<Label>();
        scene.triangle_pieces = open("triangle_pieces").get_array<std::uint32_t>();
        read_pieces(open("pieces"), scene);
        read_primitives(open("primitives"), scene);
        read_index(open("index"), index);
    } catch (const std::out_of_range&) {
        throw FileError(file.string(), "is cut short; bake the map again");
    }
    if (!is_consistent(scene, index)) throw FileError(file.string(), "contradicts itself; bake the map again");
}

}  // namespace spawnfield
