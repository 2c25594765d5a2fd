#include "base/number.h"
#include "reach/lattice.h"

#include <spawnfield/column.h>
#include <spawnfield/error.h>
#include <spawnfield/island_choice.h>

#include <algorithm>
#include <cmath>
#include <set>

namespace spawnfield {
namespace {

constexpr const char* function = "chosen_islands";

/// Numbers of islands.
using Islands = std::set<std::size_t>;

/// What the robot finds at a place.
struct Arrival {
    double height = 0;        ///< of the place, m
    bool stands = false;      ///< whether it can stand there, at one heading or more
    Islands islands = {};     ///< on which it stands
    std::string reason = {};  ///< why it cannot stand there at the first heading
};

/// Lets the robot down at a place at all headings of the graph.
Arrival arrive(const ReachGraph& graph, const Judge& judge, const Vec3& place)
{
    Arrival out{.height = place.z()};
    for (int heading = 0; heading < lattice_headings; ++heading) {
        const SettledPose pose = judge.settle(place, lattice_yaw(heading));
        if (heading == 0) out.reason = judge.describe(pose);
        out.stands |= pose.verdict == Verdict::Valid;
        if (const auto island = graph.island_of(pose)) out.islands.insert(*island);
    }
    return out;
}

/// Returns the heights from which the robot is let down at a place, m.
std::vector<double> heights_of(const StartPlace& place, const Map& map)
{
    if (place.z) return {*place.z};
    const Column column = column_at(map.geometry, place.x, place.y);
    return column.layers.empty() ? std::vector{map.bounds.max.z()} : column.layers;
}

[[noreturn]] void refuse_place(const StartPlace& place, const Arrival& found)
{
    if (found.stands)
        throw ArgumentError(function, "at " + to_string(place) +
                                          " the robot can stand, but it can go nowhere from there; give a place with "
                                          "more room around it, or a smaller step of the graph (--reach-step)");
    throw ArgumentError(function, "at " + to_string(place) + " the robot can stand at none of " +
                                      std::to_string(lattice_headings) + " headings (at yaw 0: " + found.reason +
                                      "); give a place where it can stand");
}

[[noreturn]] void refuse_as_ambiguous(const StartPlace& place, const std::vector<Arrival>& layers)
{
    std::string heights;
    for (const Arrival& layer : layers)
        heights += (heights.empty() ? "" : ", ") + number(layer.height) + " m (island " +
                   std::to_string(*layer.islands.begin()) + ")";
    const StartPlace highest{place.x, place.y, layers.front().height};
    throw ArgumentError(function, "at " + to_string(place) +
                                      " the robot can stand on several islands above each other: "
                                      "at " +
                                      heights + "; give the height, too, for example " + to_string(highest));
}

/// Returns the islands on which the robot stands at a place.
Islands islands_at(const ReachGraph& graph, const Judge& judge, const StartPlace& place)
{
    for (const double value : {place.x, place.y, place.z.value_or(0)})
        if (!std::isfinite(value)) throw ArgumentError(function, "a place", value, "finite numbers, m");
    std::vector<Arrival> arrivals, layers;
    for (const double height : heights_of(place, judge.map()))
        arrivals.push_back(arrive(graph, judge, {place.x, place.y, height}));
    std::copy_if(arrivals.begin(), arrivals.end(), std::back_inserter(layers),
                 [](const Arrival& arrival) { return !arrival.islands.empty(); });
    if (layers.empty())
        refuse_place(place, *std::max_element(arrivals.begin(), arrivals.end(),
                                              [](const Arrival& a, const Arrival& b) { return a.stands < b.stands; }));
    const auto is_other = [&](const Arrival& layer) { return layer.islands != layers.front().islands; };
    if (std::any_of(layers.begin(), layers.end(), is_other)) refuse_as_ambiguous(place, layers);
    return layers.front().islands;
}

void check(const ReachGraph& graph, const IslandChoice& choice)
{
    const std::size_t count = graph.islands().size();
    if (!(choice.min_area >= 0)) throw ArgumentError(function, "min_area", choice.min_area, ">= 0 m2");
    if (!choice.number || *choice.number < count) return;
    const std::string islands = count == 0   ? "there is no island, because the robot can stand nowhere"
                                : count == 1 ? "there is only island 0"
                                             : "there are " + std::to_string(count) + " islands, 0 to " +
                                                   std::to_string(count - 1) + ", the largest first";
    throw ArgumentError(function, "island " + std::to_string(*choice.number) + " does not exist: " + islands);
}

}  // namespace

std::string to_string(const StartPlace& place)
{
    return number(place.x) + "," + number(place.y) + (place.z ? "," + number(*place.z) : "");
}

std::vector<std::size_t> chosen_islands(const ReachGraph& graph, const Judge& judge, const IslandChoice& choice)
{
    check(graph, choice);
    std::optional<Islands> at, from;
    if (choice.at) at = islands_at(graph, judge, *choice.at);
    for (const StartPlace& place : choice.reachable_from) {
        if (!from) from.emplace();
        from->merge(islands_at(graph, judge, place));
    }
    std::vector<std::size_t> out;
    for (std::size_t island = 0; island < graph.islands().size(); ++island)
        if ((!choice.largest || island == 0) && (!choice.number || island == *choice.number) &&
            (!at || at->contains(island)) && (!from || from->contains(island)) &&
            graph.islands()[island].area >= choice.min_area)
            out.push_back(island);
    return out;
}

ReachFilter on_islands(const ReachGraph& graph, std::span<const std::size_t> islands)
{
    std::vector<char> is_chosen(graph.islands().size(), 0);  // not bool: no bits that neighbours share
    for (const std::size_t island : islands) is_chosen.at(island) = 1;
    return [graph, is_chosen = std::move(is_chosen)](const SettledPose& pose) {
        const auto island = graph.island_of(pose);
        return island && is_chosen[*island] != 0;
    };
}

}  // namespace spawnfield
