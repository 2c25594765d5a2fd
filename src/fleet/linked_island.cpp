#include <spawnfield/error.h>
#include <spawnfield/fleet.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

namespace spawnfield {
namespace {

/// The places of an island in a grid of cells, for look-ups of what is at most one cell away.
class IslandGround {
public:
    IslandGround(const ReachGraph& graph, std::size_t island, double distance) : distance_(distance)
    {
        for (const ReachPlace& place : graph.places())
            if (place.island == island) cells_[cell_of(place)].push_back({place.x, place.y, place.ground});
    }

    bool is_near(const ReachPlace& place) const
    {
        const Cell at = cell_of(place);
        for (long column = at.first - 1; column <= at.first + 1; ++column)
            for (long row = at.second - 1; row <= at.second + 1; ++row)
                if (const auto found = cells_.find({column, row});
                    found != cells_.end() && std::ranges::any_of(found->second, [&](const Vec3& point) {
                        return (point - Vec3(place.x, place.y, place.ground)).norm() <= distance_;
                    }))
                    return true;
        return false;
    }

private:
    using Cell = std::pair<long, long>;
    Cell cell_of(const ReachPlace& place) const
    {
        return {std::lround(place.x / distance_), std::lround(place.y / distance_)};
    }

    const double distance_;
    std::map<Cell, std::vector<Vec3>> cells_;
};

}  // namespace

std::optional<std::size_t> linked_island(const ReachGraph& graph, const ReachGraph& other, std::size_t island_of_other)
{
    if (island_of_other >= other.islands().size())
        throw ArgumentError("linked_island", "island_of_other", double(island_of_other),
                            "the index of an island of the other graph");
    const double distance = std::max(*graph.options().step, *other.options().step);
    const IslandGround ground(other, island_of_other, distance);
    std::vector<std::size_t> counts(graph.islands().size());
    for (const ReachPlace& place : graph.places()) counts[place.island] += ground.is_near(place);
    const auto most = std::ranges::max_element(counts);  // the first one: of equal ones, the largest island
    if (most == counts.end() || *most == 0) return std::nullopt;
    return std::size_t(most - counts.begin());
}

}  // namespace spawnfield
