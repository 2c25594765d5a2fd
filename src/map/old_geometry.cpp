#include "map/old_geometry.h"

#include "base/binary.h"

#include <algorithm>

namespace spawnfield {
namespace {

// The records of a tile of version 2: the head, then vertices, primitives, pieces, triangles, boxes (24 bytes for each
// element), ids, starts and refs (4 bytes each). An element may be in several tiles; it is taken from its home tile.

struct OldHead {
    double x0, y0, bin;
    std::uint32_t vertices, triangles, primitives, pieces, refs, bin_cols, bin_rows, unused;
};
static_assert(sizeof(OldHead) == 56);

struct OldPrimitive {
    std::array<double, 3> size, position;
    std::array<double, 9> rotation;  // column by column
    std::uint32_t part;
    ShapeKind kind;
    Label label;
    std::uint8_t home_col, home_row;
};
static_assert(sizeof(OldPrimitive) == 128);

struct OldPiece {
    double bottom;
    std::uint32_t piece, part;
    std::uint8_t solid, open, sides_up;
    std::array<std::uint8_t, 5> unused;
};
static_assert(sizeof(OldPiece) == 24);

struct OldTriangle {
    Triangle corners;
    std::uint32_t piece;
    Label label;
    std::uint8_t home_col, home_row, unused;
};
static_assert(sizeof(OldTriangle) == 20);

/// Adds the elements whose home is a tile. Returns whether the tile is consistent. Throws std::out_of_range if its
/// bytes end too early.
bool add_tile(std::string_view bytes, std::uint64_t triangle_count, std::uint64_t element_count, Scene& scene)
{
    BinaryReader in(bytes);
    const OldHead& head = in.view_array<OldHead>(1).front();
    const auto vertices = in.view_array<Vec3>(head.vertices);
    const auto primitives = in.view_array<OldPrimitive>(head.primitives);
    const auto pieces = in.view_array<OldPiece>(head.pieces);
    const auto triangles = in.view_array<OldTriangle>(head.triangles);
    const std::uint64_t elements = std::uint64_t{head.triangles} + head.primitives;
    in.view_array<std::array<float, 6>>(elements);  // boxes
    const auto ids = in.view_array<std::uint32_t>(elements);
    if (!std::all_of(vertices.begin(), vertices.end(), [](const Vec3& v) { return v.allFinite(); })) return false;
    const auto first_vertex = std::uint32_t(scene.vertices.size());
    scene.vertices.insert(scene.vertices.end(), vertices.begin(), vertices.end());
    for (const OldPiece& piece : pieces) {
        if (piece.part >= scene.parts.size() || piece.piece >= triangle_count) return false;
        if (piece.piece >= scene.pieces.size()) scene.pieces.resize(piece.piece + 1);
        Piece& to = scene.pieces[piece.piece];
        to.part = piece.part;
        to.solid = piece.solid != 0;
        to.open = piece.open != 0;
        to.sides_up = piece.sides_up != 0;
        to.bottom = piece.bottom;
    }
    for (std::size_t t = 0; t < triangles.size(); ++t) {
        const OldTriangle& from = triangles[t];
        if (ids[t] >= triangle_count || from.piece >= pieces.size() || from.label > Label::Water) return false;
        for (const std::uint32_t corner : from.corners)
            if (corner >= vertices.size()) return false;
        if (from.home_col == 0 || from.home_row == 0) continue;
        for (std::size_t c = 0; c < 3; ++c) scene.triangles[ids[t]][c] = first_vertex + from.corners[c];
        scene.triangle_labels[ids[t]] = from.label;
        scene.triangle_pieces[ids[t]] = pieces[from.piece].piece;
    }
    for (std::size_t p = 0; p < primitives.size(); ++p) {
        const OldPrimitive& from = primitives[p];
        const std::uint64_t id = ids[triangles.size() + p];
        if (id < triangle_count || id >= element_count || from.part >= scene.parts.size() ||
            from.kind > ShapeKind::Capsule || from.label > Label::Water)
            return false;
        if (from.home_col == 0 || from.home_row == 0) continue;
        const Pose pose{Vec3(from.position.data()), Mat3(from.rotation.data())};
        const Shape shape{from.kind, Vec3(from.size.data()), pose};
        if (!has_extent(shape) || !pose.position.allFinite() || !pose.rotation.allFinite()) return false;
        scene.primitives[id - triangle_count] = {shape, from.part, from.label};
    }
    return true;
}

}  // namespace

void read_old_tiles(const TileStore& tiles, std::uint64_t triangles, std::uint64_t elements, Scene& scene)
{
    // A tile needs at least 24 bytes for an element, so larger counts contradict the file.
    if (triangles > elements || elements > tiles.bytes().size() / 24) tiles.fail_inconsistent();
    tiles.expect_all();
    constexpr std::uint32_t missing = 0xffffffff;
    scene.triangles.assign(triangles, {});
    scene.triangle_labels.assign(triangles, Label::Obstacle);
    scene.triangle_pieces.assign(triangles, missing);
    scene.primitives.assign(elements - triangles, Primitive{.shape = {}, .part = missing});
    const auto is_added = [&](std::string_view bytes) {
        try {
            return add_tile(bytes, triangles, elements, scene);
        } catch (const std::out_of_range&) {
            return false;
        }
    };
    for (std::size_t level = 0; level < tiles.levels().size(); ++level)
        for (std::size_t tile = 0; tile < tiles.levels()[level].tiles.size(); ++tile) {
            const std::string_view bytes = tiles.open(level, tile, [](std::string_view) { return true; });
            if (!bytes.empty() && !is_added(bytes)) tiles.fail_inconsistent();
            // Entries that share their bytes could have more vertices than the file.
            if (scene.vertices.size() > tiles.bytes().size() / sizeof(Vec3)) tiles.fail_inconsistent();
        }
    for (const std::uint32_t piece : scene.triangle_pieces)
        if (piece == missing) tiles.fail_inconsistent();
    for (const Primitive& primitive : scene.primitives)
        if (primitive.part == missing) tiles.fail_inconsistent();
}

}  // namespace spawnfield
