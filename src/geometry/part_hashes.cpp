#include "geometry/part_hashes.h"

#include "base/binary.h"
#include "base/parallel.h"
#include "scene/elements.h"

#include <xxhash.h>

#include <memory>

namespace spawnfield {
namespace {

/// A hash of values that are appended one by one.
class Hasher {
public:
    Hasher() : state_(XXH64_createState(), XXH64_freeState) { XXH64_reset(state_.get(), 0); }

    void add(std::string_view bytes) { XXH64_update(state_.get(), bytes.data(), bytes.size()); }
    std::uint64_t hash() const { return XXH64_digest(state_.get()); }

private:
    std::unique_ptr<XXH64_state_t, decltype(&XXH64_freeState)> state_;
};

/// Appends vectors and matrices column by column.
template <class Numbers>
void put_numbers(BinaryWriter& out, const Numbers& numbers)
{
    for (const double number : numbers.reshaped()) out.put(number);
}

/// A vertex counts by its coordinates and by its number from the piece's first one, because tiles list their vertices
/// in the order of the numbers. A face group counts by its number from the part's first one.
void add_piece(const Scene& scene, const Piece& piece, std::uint32_t first_group, Hasher& hasher)
{
    constexpr std::uint32_t batch = 512;  // triangles whose bytes are hashed at a time
    BinaryWriter head;
    head.put(piece.triangle_count);
    for (const bool flag : {piece.solid, piece.open, piece.sides_up}) head.put(std::uint8_t(flag));
    head.put(piece.bottom);
    hasher.add(head.take());
    if (piece.triangle_count == 0) return;
    const std::uint32_t first_vertex = scene.triangles[piece.first_triangle][0],
                        end = piece.first_triangle + piece.triangle_count;
    for (std::uint32_t from = piece.first_triangle; from < end; from += batch) {
        BinaryWriter bytes;
        for (std::uint32_t t = from; t < std::min(end, from + batch); ++t) {
            for (const std::uint32_t corner : scene.triangles[t]) {
                bytes.put(corner - first_vertex);
                put_numbers(bytes, scene.vertices[corner]);
            }
            bytes.put(std::uint8_t(scene.triangle_labels[t]));
            const std::uint32_t group = face_group(scene, t);
            bytes.put(group == 0 ? group : group - first_group);
        }
        hasher.add(bytes.take());
    }
}

void add_primitive(const Primitive& primitive, Hasher& hasher)
{
    BinaryWriter bytes;
    bytes.put(std::uint8_t(primitive.shape.kind));
    bytes.put(std::uint8_t(primitive.label));
    put_numbers(bytes, primitive.shape.size);
    put_numbers(bytes, primitive.shape.pose.position);
    put_numbers(bytes, primitive.shape.pose.rotation);
    hasher.add(bytes.take());
}

void add_group(const FaceGroup& group, Hasher& hasher)
{
    BinaryWriter bytes;
    bytes.put_text(group.node);
    bytes.put_text(group.material);
    for (const std::uint64_t count : group.triangles) bytes.put(count);
    hasher.add(bytes.take());
}

void add_part(const Part& part, Hasher& hasher)
{
    BinaryWriter bytes;
    bytes.put_text(part.name);
    bytes.put_text(part.kind);
    bytes.put(std::uint8_t(part.label));
    for (const std::uint32_t count : {part.solid_pieces, part.sheet_pieces, part.open_edges, part.triangles})
        bytes.put(count);
    hasher.add(bytes.take());
}

}  // namespace

std::vector<std::uint64_t> hashes_of_parts(const Scene& scene, int threads)
{
    std::vector<std::vector<const Piece*>> pieces(scene.parts.size());
    std::vector<std::vector<const Primitive*>> primitives(scene.parts.size());
    for (const Piece& piece : scene.pieces) pieces[piece.part].push_back(&piece);
    for (const Primitive& primitive : scene.primitives) primitives[primitive.part].push_back(&primitive);
    std::vector<std::vector<std::uint32_t>> groups(scene.parts.size());
    for (std::uint32_t group = 0; group < scene.face_groups.size(); ++group)
        groups[scene.face_groups[group].part].push_back(group);
    std::vector<std::uint64_t> out(scene.parts.size());
    parallel_for(out.size(), threads, {}, [&](std::size_t part) {
        Hasher hasher;
        add_part(scene.parts[part], hasher);
        for (const std::uint32_t group : groups[part]) add_group(scene.face_groups[group], hasher);
        const std::uint32_t first_group = groups[part].empty() ? 0 : groups[part].front();
        for (const Piece* piece : pieces[part]) add_piece(scene, *piece, first_group, hasher);
        for (const Primitive* primitive : primitives[part]) add_primitive(*primitive, hasher);
        out[part] = hasher.hash();
    });
    return out;
}

}  // namespace spawnfield
