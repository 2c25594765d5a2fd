#include "things.h"
#include "world.h"

using namespace spawnfield;

namespace worlds {
namespace {

constexpr double size = 0.5;  // m across

template <class Add>
World lattice_of(const char* name, int heights, const Add& add)
{
    World world;
    world.scene.name = name;
    for (int k = 0; k < heights; ++k)
        for (int j = 0; j < 10; ++j)
            for (int i = 0; i < 10; ++i) add(world.scene, Pose{{double(i), double(j), double(k)}, Mat3::Identity()});
    return world;
}

}  // namespace

World benchmark_cubes(int heights)
{
    return lattice_of("benchmark-cubes", heights, [](Scene& scene, const Pose& pose) {
        hand::add_shape(scene, Label::Obstacle, {.kind = ShapeKind::Box, .size = {size, size, size}, .pose = pose});
    });
}

World benchmark_balls(int heights)
{
    hand::Mesh mesh = ball();
    for (Vec3& vertex : mesh.vertices) vertex *= size / 2;
    return lattice_of("benchmark-balls", heights, [&](Scene& scene, const Pose& pose) {
        hand::add_mesh(scene, Label::Obstacle, hand::moved(mesh, pose));
    });
}

}  // namespace worlds
