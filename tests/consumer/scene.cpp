// Makes a map from triangles in memory, without files, and counts where a robot can stand on it.
#include <spawnfield/bake.h>
#include <spawnfield/query.h>
#include <spawnfield/scene_parts.h>

#include <cstdio>

using namespace spawnfield;

int main()
{
    Scene scene;
    add_mesh(scene, "floor", Label::Terrain, {{-5, -5, 0}, {5, -5, 0}, {5, 5, 0}, {-5, 5, 0}}, {{0, 1, 2}, {0, 2, 3}});
    add_shape(scene, "crate", Label::Obstacle, box_shape({1, 1, 1}, {{2, 0, 0.5}}));
    const Judge judge(make_map(scene), load_robot("box:0.99,0.67,0.39"));
    const VerdictCounts counts = raster(judge, {.step = 0.25}).counts;
    for (const Verdict verdict : all_verdicts)
        if (counts[verdict] > 0) std::printf("%s: %zu\n", to_string(verdict), std::size_t(counts[verdict]));
}
