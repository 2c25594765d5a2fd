// Prints why poses of a file are refused: check MAP ROBOT POSES
#include <spawnfield/judge.h>
#include <spawnfield/poses.h>

#include <cstdio>
#include <exception>

int main(int, char** argv)
try {
    const spawnfield::Judge judge(spawnfield::read_map(argv[1]), spawnfield::load_robot(argv[2]));
    for (const spawnfield::Pose& pose : spawnfield::read_poses(argv[3]).poses)
        if (const auto judgement = judge.check(pose); judgement.verdict != spawnfield::Verdict::Valid)
            std::printf("%g %g: %s\n", pose.position.x(), pose.position.y(), judge.describe(pose, judgement).c_str());
} catch (const std::exception& error) {  // names the file, the place in it, the value and the limit
    std::fprintf(stderr, "check: %s\n", error.what());
    return 1;
}
