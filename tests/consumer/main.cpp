#include <spawnfield/collision.h>
#include <spawnfield/scene.h>

#include <cstdio>

int main(int, char** argv)
{
    const spawnfield::Scene scene = spawnfield::load_scene(argv[1]);
    const spawnfield::Geometry geometry(scene);
    const spawnfield::CollisionChecker checker(geometry, spawnfield::load_robot("box:0.5,0.5,0.5"));
    const bool high = checker.is_free({{3, -8, 0.5}, spawnfield::Mat3::Identity()});
    const bool sunk = checker.is_free({{3, -8, -0.2}, spawnfield::Mat3::Identity()});
    std::printf("spawnfield %s: above the floor %d, in it %d\n", spawnfield::version().c_str(), high, sunk);
    return high && !sunk ? 0 : 1;
}
