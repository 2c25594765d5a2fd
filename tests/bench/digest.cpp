#include "digest.h"

#include "geometry/geometry_impl.h"

using namespace spawnfield;

namespace bench {

std::uint64_t digest_of(const Scene& scene)
{
    Digest digest;
    for (const Part& part : scene.parts) digest.add(part.name).add(part.kind).add(part.label);
    digest.add_all(scene.vertices)
        .add_all(scene.triangles)
        .add_all(scene.triangle_labels)
        .add_all(scene.triangle_pieces);
    for (const Piece& piece : scene.pieces)
        digest.add(piece.part)
            .add(piece.first_triangle)
            .add(piece.triangle_count)
            .add(piece.solid)
            .add(piece.sides_up)
            .add(piece.bottom);
    for (const Primitive& primitive : scene.primitives) {
        const Shape& shape = primitive.shape;
        digest.add(primitive.part).add(primitive.label).add(shape.kind).add(shape.size).add(shape.pose.position);
        for (int axis = 0; axis < 3; ++axis) digest.add(Vec3(shape.pose.rotation.col(axis)));
    }
    return digest.value();
}

std::uint64_t digest_of(const Geometry& geometry)
{
    return Digest().add(std::string(geometry.impl().forests[0]->tiles.bytes())).value();
}

std::uint64_t digest_of(const TerrainMap& terrain)
{
    Digest digest;
    for (const TerrainMap::Page& page : terrain.pages) {
        digest.add(page.name);
        for (const std::string& tile : page.tiles) digest.add(tile);
    }
    return digest.value();
}

std::uint64_t digest_of(const std::vector<Judgement>& judgements)
{
    Digest digest;
    for (const Judgement& judgement : judgements) {
        digest.add(judgement.verdict);
        if (judgement.ground)
            digest.add(judgement.ground->height).add(judgement.ground->terrain).add(judgement.ground->part);
        if (judgement.hit) digest.add(judgement.hit->part);
    }
    return digest.value();
}

std::uint64_t digest_of(const RasterResult& raster)
{
    Digest digest;
    for (const RasterPose& pose : raster.poses)
        digest.add(pose.x).add(pose.y).add(pose.z).add(pose.layer).add(pose.verdict);
    for (const RasterRest& rest : raster.rests) {
        digest.add(rest.roll).add(rest.pitch).add(rest.tilt).add(rest.margin);
        digest.add(rest.tip_over).add(rest.belly).add(rest.yaw);
    }
    for (const Verdict verdict : all_verdicts) digest.add(raster.counts[verdict]);
    return digest.value();
}

std::uint64_t digest_of(const SpawnList& spawns)
{
    Digest digest;
    for (const Spawn& spawn : spawns.spawns) digest.add(spawn.position).add(spawn.yaw).add(spawn.roll).add(spawn.pitch);
    for (const Verdict verdict : all_verdicts) digest.add(spawns.counts[verdict]);
    return digest.add(spawns.draws).add(spawns.too_close).value();
}

}  // namespace bench
