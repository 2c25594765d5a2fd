// Asks for one pose at a time, as a planner does, from several threads: planner MAP ROBOT POSES_PER_THREAD
#include <spawnfield/judge.h>

#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <random>
#include <thread>
#include <vector>

using namespace spawnfield;

int main(int, char** argv)
{
    const Judge judge(read_map(argv[1]), load_robot(argv[2]));  // one for all threads
    const int poses = std::atoi(argv[3]);
    std::vector<int> valid(2);
    const auto walk = [&](std::size_t thread) {
        std::mt19937 random(static_cast<unsigned>(thread));
        std::uniform_real_distribution<double> share(0, 1);
        const Vec3 low = judge.map().bounds.min, size = judge.map().bounds.max - low;
        for (int i = 0; i < poses; ++i) {
            const Vec3 position = low + size.cwiseProduct(Vec3(share(random), share(random), share(random)));
            valid[thread] += judge.is_valid({position, rotation_from_rpy(0, 0, 6.28 * share(random))});
        }
    };
    const auto start = std::chrono::steady_clock::now();
    std::vector<std::thread> threads;
    for (std::size_t t = 0; t < valid.size(); ++t) threads.emplace_back(walk, t);
    for (std::thread& thread : threads) thread.join();
    const std::chrono::duration<double, std::micro> time = std::chrono::steady_clock::now() - start;
    std::printf("valid: %d and %d of %d; %.2f us per pose and thread\n", valid[0], valid[1], poses,
                time.count() / poses);
}
