#include "triangle_scene.h"

#include <fstream>
#include <stdexcept>

using namespace spawnfield;

namespace bench {
namespace {

constexpr std::uint64_t magic = 0x31656C676E616972;  // "riangle1"

void add_vertex(const Vec3& vertex, TriangleScene& out)
{
    const Eigen::Vector3f rounded = vertex.cast<float>();
    out.vertices.insert(out.vertices.end(), rounded.data(), rounded.data() + 3);
}

void add_label(const Scene& scene, Label label, TriangleScene& out)
{
    const std::size_t before = out.indices.size();
    for (std::size_t t = 0; t < scene.triangles.size(); ++t)
        if (scene.triangle_labels[t] == label)
            out.indices.insert(out.indices.end(), scene.triangles[t].begin(), scene.triangles[t].end());
    for (const Primitive& primitive : scene.primitives) {
        if (primitive.label != label) continue;
        for_each_side(primitive.shape, [&out](const Vec3& a, const Vec3& b, const Vec3& c) {
            for (const Vec3& corner : {a, b, c}) {
                out.indices.push_back(std::uint32_t(out.vertices.size() / 3));
                add_vertex(corner, out);
            }
        });
    }
    out.counts[std::size_t(label)] = (out.indices.size() - before) / 3;
}

template <class T>
void write_all(std::ofstream& stream, const T* values, std::size_t count)
{
    stream.write(reinterpret_cast<const char*>(values), std::streamsize(count * sizeof(T)));
}

template <class T>
void read_all(std::ifstream& stream, T* values, std::size_t count)
{
    stream.read(reinterpret_cast<char*>(values), std::streamsize(count * sizeof(T)));
}

}  // namespace

TriangleScene triangle_scene_of(const Scene& scene, const Bounds& bounds)
{
    for (const Primitive& primitive : scene.primitives)
        if (primitive.shape.kind != ShapeKind::Box)
            throw std::invalid_argument(
                "Embree alone: the scene has a primitive that is not a box, which has no "
                "triangles; only boxes and meshes are supported");
    TriangleScene out;
    out.bounds = bounds;
    for (const Vec3& vertex : scene.vertices) add_vertex(vertex, out);
    for (const Label label : {Label::Terrain, Label::Obstacle, Label::Water}) add_label(scene, label, out);
    out.vertices.push_back(0);
    return out;
}

void write_triangles(const std::filesystem::path& file, const TriangleScene& scene)
{
    std::ofstream stream(file, std::ios::binary);
    const std::uint64_t sizes[] = {magic, scene.vertices.size(), scene.indices.size()};
    write_all(stream, sizes, 3);
    write_all(stream, scene.counts.data(), scene.counts.size());
    write_all(stream, scene.bounds.min.data(), 3);
    write_all(stream, scene.bounds.max.data(), 3);
    write_all(stream, scene.vertices.data(), scene.vertices.size());
    write_all(stream, scene.indices.data(), scene.indices.size());
    if (!stream.flush()) throw std::runtime_error("cannot write " + file.string());
}

TriangleScene read_triangles(const std::filesystem::path& file)
{
    std::ifstream stream(file, std::ios::binary);
    std::uint64_t sizes[3] = {};
    read_all(stream, sizes, 3);
    if (!stream || sizes[0] != magic)
        throw std::runtime_error(
            file.string() + " is not a file of triangles; spawnfield_bench --write-maps writes one beside each map");
    TriangleScene out;
    read_all(stream, out.counts.data(), out.counts.size());
    read_all(stream, out.bounds.min.data(), 3);
    read_all(stream, out.bounds.max.data(), 3);
    out.vertices.resize(sizes[1]);
    out.indices.resize(sizes[2]);
    read_all(stream, out.vertices.data(), out.vertices.size());
    read_all(stream, out.indices.data(), out.indices.size());
    if (!stream) throw std::runtime_error(file.string() + " ends too early; write it again with --write-maps");
    return out;
}

}  // namespace bench
