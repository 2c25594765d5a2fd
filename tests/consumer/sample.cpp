// Prints places where a robot can stand: sample MAP ROBOT
#include <spawnfield/query.h>

#include <cstdio>

int main(int, char** argv)
{
    const spawnfield::Judge judge(spawnfield::read_map(argv[1]), spawnfield::load_robot(argv[2]));
    for (const auto& spawn : sample(judge, {.count = 10, .min_distance = 1, .random_yaw = true}).spawns)
        std::printf("%.2f %.2f %.2f, roll %.2f, pitch %.2f, yaw %.2f\n", spawn.position.x(), spawn.position.y(),
                    spawn.position.z(), spawn.roll, spawn.pitch, spawn.yaw);
}
