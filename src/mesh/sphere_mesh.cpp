#include "mesh/sphere_mesh.h"

#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>

namespace spawnfield {
namespace {

/// Returns an icosahedron of radius 1. Its corners are (0, ±1, ±phi) and their cyclic permutations, before they are
/// normalized; its faces are the triples of corners that are all 2 apart.
SphereMesh icosahedron()
{
    SphereMesh mesh;
    for (const double a : {-1.0, 1.0})
        for (const double b : {-std::numbers::phi, std::numbers::phi})
            for (int axis = 0; axis < 3; ++axis) {
                Vec3 corner = Vec3::Zero();
                corner[(axis + 1) % 3] = a;
                corner[(axis + 2) % 3] = b;
                mesh.vertices.push_back(corner);
            }
    const auto are_neighbours = [&](std::uint32_t i, std::uint32_t j) {
        return (mesh.vertices[i] - mesh.vertices[j]).norm() < 2.1;
    };
    for (std::uint32_t i = 0; i < 12; ++i)
        for (std::uint32_t j = i + 1; j < 12; ++j)
            for (std::uint32_t k = j + 1; k < 12; ++k) {
                if (!are_neighbours(i, j) || !are_neighbours(j, k) || !are_neighbours(k, i)) continue;
                const Vec3 normal = (mesh.vertices[j] - mesh.vertices[i]).cross(mesh.vertices[k] - mesh.vertices[i]);
                if (normal.dot(mesh.vertices[i]) > 0)
                    mesh.triangles.push_back({i, j, k});
                else
                    mesh.triangles.push_back({i, k, j});
            }
    for (Vec3& vertex : mesh.vertices) vertex.normalize();
    return mesh;
}

SphereMesh cut_in_four(SphereMesh mesh)
{
    std::map<std::pair<std::uint32_t, std::uint32_t>, std::uint32_t> middles;
    const auto middle = [&](std::uint32_t i, std::uint32_t j) {
        const auto [found, is_new] = middles.try_emplace(std::minmax(i, j), std::uint32_t(mesh.vertices.size()));
        if (is_new) mesh.vertices.push_back((mesh.vertices[i] + mesh.vertices[j]).normalized());
        return found->second;
    };
    std::vector<Triangle> finer;
    for (const auto& [i, j, k] : mesh.triangles) {
        const std::uint32_t ij = middle(i, j), jk = middle(j, k), ki = middle(k, i);
        finer.insert(finer.end(), {{i, ij, ki}, {ij, j, jk}, {ki, jk, k}, {ij, jk, ki}});
    }
    mesh.triangles = std::move(finer);
    return mesh;
}

}  // namespace

SphereMesh mesh_around_unit_sphere(int rounds)
{
    SphereMesh mesh = icosahedron();
    for (int round = 0; round < rounds; ++round) mesh = cut_in_four(std::move(mesh));
    double nearest = 1;  // smallest distance from the centre to a face
    for (const auto& [i, j, k] : mesh.triangles) {
        const Vec3 normal =
            (mesh.vertices[j] - mesh.vertices[i]).cross(mesh.vertices[k] - mesh.vertices[i]).normalized();
        nearest = std::min(nearest, normal.dot(mesh.vertices[i]));
    }
    for (Vec3& vertex : mesh.vertices) vertex /= nearest;
    return mesh;
}

}  // namespace spawnfield
