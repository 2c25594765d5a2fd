// Makes a robot from a box and a convex hull in code, and prints its offset above the ground of a map: robot MAP
#include <spawnfield/query.h>
#include <spawnfield/robot_parts.h>

#include <cstdio>

using namespace spawnfield;

int main(int, char** argv)
{
    const RobotPart body = shape_part(box_shape({0.9, 0.6, 0.2}, {{0, 0, 0.2}}), "body");
    const RobotPart nose = hull_part({{0.45, -0.3, 0.1}, {0.45, 0.3, 0.1}, {0.45, 0, 0.3}, {0.7, 0, 0.1}}, "nose");
    const std::vector<Vec3> wheels = {{0.4, 0.3, 0}, {0.4, -0.3, 0}, {-0.4, 0.3, 0}, {-0.4, -0.3, 0}};
    const Robot cart = make_robot("cart", {body, nose}, wheels);
    const SpawnList found = sample(Judge(read_map(argv[1]), cart, {.max_slope = 0.2}),
                                   {.count = 5, .stance = Stance::Level});
    std::printf("%zu spawns, %g m above the ground\n", found.spawns.size(), auto_offset(cart));
}
