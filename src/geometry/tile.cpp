#include "geometry/tile.h"

#include "base/bits.h"
#include "base/tile_store.h"
#include "scene/elements.h"

#include <bit>
#include <compare>
#include <functional>

namespace spawnfield {
namespace {

/// Returns the `count` values that begin at `next`, and moves `next` behind them.
template <class T>
std::span<const T> take(const char*& next, std::size_t count)
{
    const std::span<const T> out(reinterpret_cast<const T*>(next), count);
    next += count * sizeof(T);
    return out;
}

/// Puts values that lie close together into order with a bit for each, which is faster than sorting.
class NearValues {
public:
    static constexpr std::uint32_t most = 1 << 13;  ///< difference of the largest and the smallest value is below it

    /// numbers[k] becomes the place of values[k] among the distinct values, of which there are at most 256.
    NearValues(const std::vector<std::uint32_t>& values, std::uint32_t low, std::uint32_t high,
               std::vector<std::uint8_t>& numbers)
        : low_(low), words_((high - low) / 64 + 1)
    {
        std::fill_n(bits_.begin(), words_, 0);
        for (const std::uint32_t value : values) bits_[(value - low) / 64] |= std::uint64_t{1} << (value - low) % 64;
        std::array<std::uint8_t, most / 64> before;  // number of bits in the words before each word
        for (std::size_t word = 0; word < words_; ++word) {
            before[word] = std::uint8_t(count_);
            count_ += std::size_t(std::popcount(bits_[word]));
        }
        for (std::size_t k = 0; k < values.size(); ++k) {
            const std::uint32_t bit = values[k] - low;
            const std::uint64_t below = (std::uint64_t{1} << bit % 64) - 1;
            numbers[k] = std::uint8_t(before[bit / 64] + std::popcount(bits_[bit / 64] & below));
        }
    }

    std::vector<std::uint32_t> sorted() const
    {
        std::vector<std::uint32_t> out;
        out.reserve(count_);
        for (std::uint32_t word = 0; word < words_; ++word)
            for_each_bit(bits_[word], [&](std::uint32_t bit) { out.push_back(low_ + 64 * word + bit); });
        return out;
    }

private:
    std::uint32_t low_;
    std::size_t words_, count_ = 0;
    std::array<std::uint64_t, most / 64> bits_;
};

/// A piece and one of its face groups, as in Scene::triangle_groups.
struct PieceGroup {
    std::uint32_t piece, group;

    auto operator<=>(const PieceGroup&) const = default;
};

/// Builds the bytes of one tile.
class TileBuilder {
public:
    TileBuilder(const Scene& scene, const std::vector<ElementBox>& boxes, std::span<const std::uint32_t> elements,
                const ElementNumbers& first)
        : scene_(scene), boxes_(boxes), elements_(elements), first_(first)
    {
    }

    std::string build()
    {
        number_corners();
        const GridBytes grid = triangle_grid_of(triangles_from_above());
        TileHead head{.scales = {},
                      .vertices = std::uint8_t(vertices_.size()),
                      .triangles = std::uint8_t(triangles_),
                      .primitives = std::uint8_t(elements_.size() - triangles_),
                      .pieces = std::uint8_t(pieces_.size()),
                      .grid = grid.size};
        for (std::size_t axis = 0; axis < 3; ++axis) head.scales[axis] = scale_along(axis);
        TileBoxes numbers{};
        for (std::size_t axis = 0; axis < 3; ++axis)
            for (std::size_t e = 0; e < elements_.size(); ++e) {
                numbers.min[axis][e] = head.scales[axis].number_of(boxes_[elements_[e]].min[axis]);
                numbers.max[axis][e] = head.scales[axis].number_of(boxes_[elements_[e]].max[axis]);
            }
        out_.reserve(tile_size(head));
        put(head);
        put(numbers);
        out_ += grid.bytes;
        for (const std::uint32_t vertex : vertices_) put(scene_.vertices[vertex]);
        for (std::size_t e = triangles_; e < elements_.size(); ++e) put(packed_primitive(elements_[e]));
        for (const PieceGroup& piece : pieces_) put(packed_piece(piece));
        for (const std::uint32_t element : elements_) put(first_.element + element);
        for (std::size_t e = 0; e < triangles_; ++e) put(packed_triangle(e));
        return std::move(out_);
    }

private:
    /// Collects the vertices and the pieces of the tile's triangles. Their order gives them their numbers in the tile.
    void number_corners()
    {
        triangles_ = std::size_t(std::partition_point(elements_.begin(), elements_.end(),
                                                      [&](std::uint32_t e) { return is_triangle(scene_, e); }) -
                                 elements_.begin());
        std::vector<std::uint32_t> corners;
        std::vector<PieceGroup> pieces;
        for (std::size_t e = 0; e < triangles_; ++e) {
            for (const std::uint32_t corner : scene_.triangles[elements_[e]]) corners.push_back(corner);
            pieces.push_back({scene_.triangle_pieces[elements_[e]], face_group(scene_, elements_[e])});
        }
        vertices_ = distinct(corners, corner_numbers_);
        pieces_ = distinct(pieces, piece_numbers_);
    }

    /// Returns the distinct values, ascending. numbers[k] becomes the place of values[k] among them. There are at most
    /// TileBoxes::most values.
    static std::vector<PieceGroup> distinct(const std::vector<PieceGroup>& values, std::vector<std::uint8_t>& numbers)
    {
        numbers.assign(values.size(), 0);
        const bool all_equal = std::adjacent_find(values.begin(), values.end(), std::not_equal_to<>()) == values.end();
        if (all_equal && !values.empty()) return {values.front()};  // most often
        std::vector<PieceGroup> out = values;
        std::sort(out.begin(), out.end());
        out.erase(std::unique(out.begin(), out.end()), out.end());
        for (std::size_t k = 0; k < values.size(); ++k)
            numbers[k] = std::uint8_t(std::lower_bound(out.begin(), out.end(), values[k]) - out.begin());
        return out;
    }

    /// Returns the distinct values, ascending. numbers[k] becomes the place of values[k] among them. There are at most
    /// 3 * TileBoxes::most values.
    static std::vector<std::uint32_t> distinct(const std::vector<std::uint32_t>& values,
                                               std::vector<std::uint8_t>& numbers)
    {
        numbers.assign(values.size(), 0);
        const auto [low, high] = std::minmax_element(values.begin(), values.end());
        if (!values.empty() && *high - *low < NearValues::most)
            return NearValues(values, *low, *high, numbers).sorted();
        std::vector<std::uint64_t> sorted;  // value and place in one number, which is sorted fast
        for (std::size_t k = 0; k < values.size(); ++k) sorted.push_back(std::uint64_t{values[k]} << 8 | k);
        std::sort(sorted.begin(), sorted.end());
        std::vector<std::uint32_t> out;
        for (const std::uint64_t both : sorted) {
            const auto value = std::uint32_t(both >> 8);
            if (out.empty() || out.back() != value) out.push_back(value);
            numbers[both & 255] = std::uint8_t(out.size() - 1);
        }
        return out;
    }

    std::vector<TriangleFromAbove> triangles_from_above() const
    {
        std::vector<TriangleFromAbove> out;
        for (std::size_t e = 0; e < triangles_; ++e) {
            const auto [a, b, c] = corners_of(scene_, elements_[e]);
            out.push_back({{{a.x(), a.y()}, {b.x(), b.y()}, {c.x(), c.y()}}});
        }
        return out;
    }

    TileScale scale_along(std::size_t axis) const
    {
        float low = std::numeric_limits<float>::infinity(), high = -low;
        for (const std::uint32_t element : elements_) {
            low = std::min(low, boxes_[element].min[axis]);
            high = std::max(high, boxes_[element].max[axis]);
        }
        return {low, high > low ? 255 / (high - low) : 0};
    }

    TileTriangle packed_triangle(std::size_t in_tile) const
    {
        TileTriangle out{};
        for (std::size_t corner = 0; corner < 3; ++corner) out.corners[corner] = corner_numbers_[3 * in_tile + corner];
        out.piece = piece_numbers_[in_tile];
        out.label = scene_.triangle_labels[elements_[in_tile]];
        return out;
    }

    TilePiece packed_piece(const PieceGroup& piece) const
    {
        const Piece& from = scene_.pieces[piece.piece];
        TilePiece out{};
        out.bottom = from.bottom;
        out.piece = first_.piece + piece.piece;
        out.part = first_.part + from.part;
        out.solid = from.solid;
        out.open = from.open;
        out.sides_up = from.sides_up;
        if (piece.group > 0) out.group = first_.group + piece.group;
        return out;
    }

    TilePrimitive packed_primitive(std::uint32_t element) const
    {
        const Primitive& from = primitive_of(scene_, element);
        TilePrimitive out{};
        Vec3::Map(out.size.data()) = from.shape.size;
        Vec3::Map(out.position.data()) = from.shape.pose.position;
        Mat3::Map(out.rotation.data()) = from.shape.pose.rotation;
        out.box = boxes_[element];
        out.part = first_.part + from.part;
        out.kind = from.shape.kind;
        out.label = from.label;
        return out;
    }

    template <class T>
    void put(const T& value)
    {
        out_.append(reinterpret_cast<const char*>(&value), sizeof value);
    }

    const Scene& scene_;
    const std::vector<ElementBox>& boxes_;
    const std::span<const std::uint32_t> elements_;
    const ElementNumbers& first_;
    std::size_t triangles_ = 0;
    std::vector<std::uint32_t> vertices_;
    std::vector<PieceGroup> pieces_;
    std::vector<std::uint8_t> corner_numbers_, piece_numbers_;  ///< of the corners and the triangles of the tile
    std::string out_;
};

}  // namespace

std::uint64_t tile_size(const TileHead& head)
{
    return sizeof(TileHead) + sizeof(TileBoxes) + head.grid.bytes() + head.vertices * sizeof(Vec3) +
           head.primitives * (sizeof(TilePrimitive) + 4) + head.pieces * sizeof(TilePiece) +
           head.triangles * (sizeof(TileTriangle) + 4);
}

Tile::Tile(std::string_view bytes)
    : head(reinterpret_cast<const TileHead*>(bytes.data())),
      boxes(reinterpret_cast<const TileBoxes*>(bytes.data() + sizeof(TileHead))),
      grid_bytes(bytes.data() + sizeof(TileHead) + sizeof(TileBoxes))
{
    const char* next = grid_bytes + head->grid.bytes();
    vertices = take<Vec3>(next, head->vertices);
    primitives = take<TilePrimitive>(next, head->primitives);
    pieces = take<TilePiece>(next, head->pieces);
    ids = take<std::uint32_t>(next, elements());
    triangles = take<TileTriangle>(next, head->triangles);
    alive = elements() < TileBoxes::most ? (std::uint64_t{1} << elements()) - 1 : ~std::uint64_t{0};
}

namespace {

/// Returns whether all indices and labels of a tile's triangles are below their limits. Compares 16 bytes at a time.
bool has_consistent_triangles(const Tile& tile)
{
    if (tile.triangles.empty()) return true;
    if (tile.vertices.empty() || tile.pieces.empty()) return false;
    const auto last_vertex = std::uint8_t(tile.vertices.size() - 1), last_piece = std::uint8_t(tile.pieces.size() - 1);
    constexpr std::size_t width = sizeof(SixteenBytes);
    std::array<TileTriangle, width> largest;  // as many bytes as a whole number of SixteenBytes
    largest.fill({{last_vertex, last_vertex, last_vertex}, last_piece, Label::Water});
    std::array<TileTriangle, TileBoxes::most> triangles{};
    std::memcpy(triangles.data(), tile.triangles.data(), tile.triangles.size_bytes());
    const auto at = [](const auto& records, std::size_t byte) {
        return sixteen_at(reinterpret_cast<const char*>(records.data()) + byte);
    };
    SixteenBytes over{};
    for (std::size_t byte = 0; byte < tile.triangles.size_bytes(); byte += width)
        over |= excess(at(triangles, byte), at(largest, byte % sizeof largest));
    return bits_of(SixteenBytes(over == 0)) == 0xffff;
}

}  // namespace

bool is_consistent_tile(std::string_view bytes, const TileLimits& limits)
{
    if (bytes.size() < sizeof(TileHead)) return false;
    TileHead head;
    std::memcpy(&head, bytes.data(), sizeof head);
    const std::uint64_t size = tile_size(head);
    if (bytes.size() < size || bytes.size() >= size + tile_alignment) return false;
    if (std::size_t{head.triangles} + head.primitives > TileBoxes::most) return false;
    const Tile tile(bytes);
    if (!has_consistent_triangles(tile)) return false;
    if (tile.has_grid() && !is_consistent_grid(head.grid, tile.grid(), head.triangles)) return false;
    for (const TilePiece& p : tile.pieces)
        if (p.part >= limits.parts || p.group > limits.groups) return false;
    for (const TilePrimitive& p : tile.primitives)
        if (p.kind > ShapeKind::Capsule || p.label > Label::Water || p.part >= limits.parts) return false;
    return true;
}

std::string tile_of(const Scene& scene, const std::vector<ElementBox>& boxes, std::span<const std::uint32_t> elements,
                    const ElementNumbers& first)
{
    return TileBuilder(scene, boxes, elements, first).build();
}

}  // namespace spawnfield
