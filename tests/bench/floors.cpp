#include "floors.h"

#include "worlds/things.h"

#include <algorithm>

using namespace spawnfield;
using namespace worlds;

namespace bench {
namespace {

constexpr double length = 40, width = 30, room = 5, storey = 3, slab = 0.25, wall = 0.2;
constexpr int storeys = 4, rooms_x = 8, rooms_y = 6;

/// The stairwell consists of the last two rooms along x, at y = 0. There every slab above the ground floor has a hole.
constexpr double shaft_x0 = 30, shaft_x1 = 39.8, shaft_y0 = 0.2, shaft_y1 = 2.2;

void add_slab(Scene& scene, int level)
{
    const double top = level * storey;
    const BlockGrid grid = {{0, shaft_x0, shaft_x1 - 1.5, length},
                            {0, shaft_y0, shaft_y1, width},
                            {top - slab, top},
                            [level](int i, int j, int) { return level == 0 || !(i == 1 && j == 1); }};
    hand::add_mesh(scene, Label::Terrain, blocks(grid));
    scene.parts.back().name = "slab-" + std::to_string(level);
}

/// Adds a ramp along the stairwell, from the floor of a storey up to the next one.
void add_ramp(Scene& scene, int level)
{
    const double from = shaft_x0 + 0.3, to = shaft_x1 - 1.5, bottom = level * storey, top = bottom + storey;
    const hand::Mesh side = hand::extruded({{from, bottom}, {from + 0.6, bottom}, {to, top - slab}, {to, top}},
                                           -shaft_y1, -shaft_y0);
    Mat3 upright;  // maps (x, y, z) to (x, -z, y)
    upright << 1, 0, 0, 0, 0, -1, 0, 1, 0;
    hand::add_mesh(scene, Label::Terrain, hand::moved(side, {Vec3::Zero(), upright}));
    scene.parts.back().name = "ramp-" + std::to_string(level);
}

/// Returns the coordinates of the walls along one axis: the two faces of each wall, and the two sides of a door or
/// window in each room.
std::vector<double> wall_lines(int rooms, double total)
{
    std::vector<double> lines;
    for (int i = 0; i <= rooms; ++i) {
        const double centre = std::clamp(i * room, wall / 2, total - wall / 2);
        lines.insert(lines.end(), {centre - wall / 2, centre + wall / 2});
        if (i < rooms) lines.insert(lines.end(), {i * room + 1.9, i * room + 3.1});
    }
    return lines;
}

/// Along an axis the blocks repeat every four: wall, room, opening, room.
bool is_wall(int block) { return block % 4 == 0; }
bool is_opening(int block) { return block % 4 == 2; }

/// The doors, windows and missing walls of a storey, drawn once.
class Openings {
public:
    Openings(Random& random, bool ground_floor)
    {
        for (char& open : doors_) open = random.chance(0.75);
        for (char& missing : gaps_) missing = random.chance(0.12);
        ground_floor_ = ground_floor;
    }

    /// Returns whether block (i, j) of level k of the walls is filled; k is 0 for the sill, 1 for the window and 2 for
    /// the lintel of the door.
    bool filled(int i, int j, int k) const
    {
        const bool along_y = is_wall(i), along_x = is_wall(j);
        if (!along_x && !along_y) return false;
        if (along_x && along_y) return true;  // a corner between two walls
        if (is_in_shaft(i, j)) return false;
        const int along = along_y ? j : i, line = along_y ? i : j;
        const bool outer = line == 0 || line == 4 * (along_y ? rooms_x : rooms_y);
        const std::size_t slot = std::size_t((along / 4 * 64 + line / 4 * 2 + along_y) % 1024);
        if (outer) return !is_opening(along) || (k != 1 && !(ground_floor_ && k == 0 && doors_[slot]));
        if (gaps_[slot]) return false;  // no wall between these rooms
        return !is_opening(along) || !doors_[slot] || k == 2;
    }

private:
    /// Returns whether a wall is left out because it would cross the ramp.
    static bool is_in_shaft(int i, int j) { return is_wall(i) && i / 4 >= 6 && i / 4 < rooms_x && j < 4; }

    std::array<char, 1024> doors_{}, gaps_{};
    bool ground_floor_ = false;
};

void add_walls(Scene& scene, Random& random, int level)
{
    const double floor = level * storey;
    const Openings openings(random, level == 0);
    const BlockGrid grid = {wall_lines(rooms_x, length),
                            wall_lines(rooms_y, width),
                            {floor, floor + 0.9, floor + 2.1, floor + storey - slab},
                            [&](int i, int j, int k) { return openings.filled(i, j, k); }};
    hand::add_mesh(scene, Label::Obstacle, blocks(grid));
    scene.parts.back().name = "walls-" + std::to_string(level);
}

void add_box(Scene& scene, const Vec3& size, const Vec3& bottom, double yaw)
{
    Shape box;
    box.size = size;
    box.pose = {bottom + Vec3(0, 0, size.z() / 2), rotation_from_rpy(0, 0, yaw)};
    hand::add_shape(scene, Label::Obstacle, box);
}

/// Adds a table on four legs with two chairs, or a cupboard, or nothing.
void furnish(Scene& scene, Random& random, const Vec3& corner)
{
    const double x = random.between(1.2, room - 1.2), y = random.between(1.2, room - 1.2),
                 yaw = random.between(-1.57, 1.57);
    const Vec3 place = corner + Vec3(x, y, 0);
    if (random.chance(0.3)) return;
    if (random.chance(0.3)) return add_box(scene, {1.2, 0.45, 1.9}, place, yaw);
    const Mat3 turn = rotation_from_rpy(0, 0, yaw);
    add_box(scene, {1.6, 0.8, 0.04}, place + Vec3(0, 0, 0.71), yaw);
    for (const double side_x : {-0.72, 0.72})
        for (const double side_y : {-0.34, 0.34})
            add_box(scene, {0.06, 0.06, 0.71}, place + turn * Vec3(side_x, side_y, 0), yaw);
    for (const double side : {-0.75, 0.75})
        add_box(scene, {0.45, 0.45, 0.45}, place + turn * Vec3(0, side, 0), yaw + random.between(-0.4, 0.4));
}

void add_parapet(Scene& scene)
{
    const double roof = storeys * storey;
    const BlockGrid grid = {
        {0, wall, length - wall, length}, {0, wall, width - wall, width}, {roof, roof + 1}, [](int i, int j, int) {
            return i != 1 || j != 1;
        }};
    hand::add_mesh(scene, Label::Obstacle, blocks(grid));
    scene.parts.back().name = "parapet";
}

}  // namespace

Scene floors_scene(std::uint64_t seed)
{
    Random random(seed);
    Scene scene;
    scene.name = "floors";
    for (int level = 0; level <= storeys; ++level) add_slab(scene, level);
    for (int level = 0; level < storeys; ++level) {
        add_ramp(scene, level);
        add_walls(scene, random, level);
        for (int row = 0; row < rooms_y; ++row)
            for (int col = 0; col < rooms_x; ++col)
                if (row > 0 || col < 6) furnish(scene, random, {col * room, row * room, level * storey});
    }
    add_parapet(scene);
    return scene;
}

}  // namespace bench
