#include "valley_town.h"

#include <array>
#include <cmath>
#include <numbers>

namespace worlds {
namespace {

constexpr double pi = std::numbers::pi;
constexpr double square = 18, street = 4.5,
                 street_end = 88;  // m: half of a side, half of the width, length from the centre

class Town {
public:
    Town(Placer& placer, Random& random, const TownFrame& frame) : placer_(placer), random_(random), frame_(frame) {}

    void build()
    {
        add_square();
        add_church();
        for (int arm = 0; arm < 4; ++arm) add_street(arm * pi / 2);
        for (int quarter = 0; quarter < 4; ++quarter) add_back_houses(quarter * pi / 2);
        add_garden_trees();
    }

private:
    /// Returns the point (u, v) of the town after a rotation of the town around its centre.
    Vec2 turned(double turn, double u, double v) const
    {
        return TownFrame{frame_.centre, frame_.turn + turn}.point(u, v);
    }
    void add(const char* kind, const Compound& compound, double turn, double u, double v, double yaw)
    {
        placer_.add(kind, compound, turned(turn, u, v), frame_.turn + turn + yaw);
    }

    void add_square();
    void add_church();
    void add_street(double turn);
    bool add_house(double turn, double u, double v, double yaw);
    void add_back_houses(double turn);
    void add_garden(double turn, double u, double v);
    void add_garden_trees();

    Placer& placer_;
    Random& random_;
    const TownFrame frame_;
};

void Town::add_square()
{
    constexpr int benches = 8;
    placer_.keep_clear({frame_.centre, square});
    add("fountain", fountain(), 0, 0, 0, 0);
    for (int i = 0; i < benches; ++i) add("bench", bench(), 2 * pi * (i + 0.5) / benches, 9.5, 0, -pi / 2);
    for (int corner = 0; corner < 4; ++corner) {
        const double turn = corner * pi / 2;
        add("lamp", street_lamp(), turn, 13, 13, 5 * pi / 4);
        add("tree", broad_tree(random_), turn, 16, 9, 0);
        add("tree", broad_tree(random_), turn, 16, -9, 0);
    }
}

void Town::add_church()
{
    constexpr double u = -38, v = 36;  // m
    add("church", church_of_boxes(), 0, u, v, 0);
    placer_.keep_clear({frame_.point(u - 8, v), 10});
    placer_.keep_clear({frame_.point(u + 8, v), 10});
}

/// Adds a house unless its ground is taken or wet. Returns whether it did.
bool Town::add_house(double turn, double u, double v, double yaw)
{
    const HouseSize size = {random_.between(9.5, 13), random_.between(7.5, 9.5), random_.between(2.8, 5.8)};
    const Compound house = house_of_boxes(random_, size);
    const Disc ground = {turned(turn, u, v), 7.2};
    if (!placer_.is_clear(ground) || !placer_.land().is_dry(ground.centre, 1)) return false;
    add("house", house, turn, u, v, yaw + random_.between(-0.04, 0.04));
    placer_.keep_clear(ground);
    return true;
}

/// Adds one arm of the crossing: houses on both sides that face the street, lamps, and parked cars.
void Town::add_street(double turn)
{
    constexpr double front = 7, first = 30, spacing = 16.5;  // m
    for (const double side : {-1.0, 1.0})
        for (double u = first; u < street_end; u += spacing)
            if (random_.chance(0.92))
                add_house(turn, u + random_.between(-0.8, 0.8), side * (front + 4.7), side < 0 ? pi : 0);
    for (double u = 24; u < street_end; u += 19) add("lamp", street_lamp(), turn, u, 4.4, -pi / 2);
    for (double u = 27; u < street_end; u += random_.between(14, 30))
        add("car", car_of_boxes(random_), turn, u, -3.1, 0);
    placer_.keep_clear(frame_.centre, turned(turn, street_end, 0), street);
}

void Town::add_back_houses(double turn)
{
    constexpr std::array<std::array<double, 2>, 5> places = {{{36, 36}, {36, 56}, {57, 38}, {56, 56}, {76, 36}}};
    for (const auto& [u, v] : places) {
        const double yaw = random_.below(4) * pi / 2;
        if (add_house(turn, u, v, yaw) && random_.chance(0.6)) add_garden(turn, u, v);
    }
}

/// Adds fences on three sides of a plot, one of them with a gap.
void Town::add_garden(double turn, double u, double v)
{
    constexpr double half = 9, gap = 5;  // m
    const auto add_fence = [&](const Vec2& from, double length, double yaw) {
        add("fence", fence(length), turn, from.x(), from.y(), yaw);
        const Vec2 to = from + length * Vec2(std::cos(yaw), std::sin(yaw));
        placer_.keep_clear(turned(turn, from.x(), from.y()), turned(turn, to.x(), to.y()), 0.3);
    };
    add_fence({u - half, v + half}, 2 * half, 0);
    add_fence({u + half, v - half}, 2 * half, pi / 2);
    add_fence({u - half, v - half}, 2 * half - gap, 0);
}

void Town::add_garden_trees()
{
    constexpr int wanted = 90;
    for (int i = 0; i < wanted; ++i) {
        const double turn = random_.between(-pi, pi), out = random_.between(25, 95);
        const Disc ground = {turned(turn, out, 0), 2};
        const Compound tree = random_.chance(0.7) ? broad_tree(random_) : bush(random_);
        if (!placer_.is_clear(ground)) continue;
        placer_.add(tree.size() == 1 ? "bush" : "tree", tree, ground.centre, 0);
        placer_.keep_clear(ground);
    }
}

}  // namespace

void add_town(Placer& placer, Random& random, const TownFrame& frame) { Town(placer, random, frame).build(); }

}  // namespace worlds
