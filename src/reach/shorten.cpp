#include "reach/shorten.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>

namespace spawnfield {
namespace {

constexpr int rounds = 3;               // in which all corners are cut
constexpr int bisections = 5;           // for the size of a cut
constexpr double smallest_gain = 1e-3;  // of the path's length: less is not worth a cut

/// A piece of the path between two corners.
struct Piece {
    std::vector<Stop> stops;
    double length = 0;         ///< m
    bool is_straight = false;  ///< otherwise, it is a way of the graph
};

class Shortener {
public:
    Shortener(const ReachGraph::Impl& graph, const std::vector<Stop>& stops, const std::vector<double>& lengths)
        : ways_(graph), stops_(stops), lengths_(lengths), so_far_(stops.size(), 0)
    {
        std::partial_sum(lengths.begin(), lengths.end(), so_far_.begin() + 1);
    }

    ShortPath run()
    {
        for (std::size_t at = 0; at + 1 < stops_.size();) at = go_on(at);
        for (int round = 0; round < rounds; ++round)
            for (std::size_t corner = 1; corner < pieces_.size(); ++corner)
                if (cut(corner)) ++corner;  // the corner at the other end of the cut is for the next round
        ShortPath out{.stops = {stops_.front()}};
        for (const Piece& piece : pieces_) {
            out.stops.insert(out.stops.end(), piece.stops.begin() + 1, piece.stops.end());
            out.length += piece.length;
        }
        return out;
    }

private:
    std::optional<Piece> straight(const Stop& from, const Stop& to, bool ends_anywhere = false)
    {
        auto way = ways_.find(from, to, ends_anywhere);
        if (!way) return std::nullopt;
        const double length = length_between(*way);
        return Piece{std::move(*way), length, true};
    }

    /// Adds the piece that begins at a stop. Returns the stop at its end.
    std::size_t go_on(std::size_t at)
    {
        const std::size_t last = stops_.size() - 1;
        std::size_t end = at + 1;
        Piece best{{stops_[at], stops_[end]}, lengths_[at], false};
        const auto can_reach = [&](std::size_t stop) {
            auto piece = straight(stops_[at], stops_[stop]);
            if (!piece || piece->length > so_far_[stop] - so_far_[at]) return false;
            best = std::move(*piece);
            end = stop;
            return true;
        };
        std::size_t beyond = last + 1;  // the nearest stop that was tried without success
        if (!can_reach(last)) {
            beyond = last;
            for (std::size_t ahead = 2; at + ahead < beyond; ahead *= 2)
                if (!can_reach(at + ahead)) beyond = at + ahead;
            while (beyond - end > 1)
                if (const std::size_t middle = end + (beyond - end) / 2; !can_reach(middle)) beyond = middle;
        }
        if (!best.is_straight) can_reach(end);  // a straight way can be cut later
        pieces_.push_back(std::move(best));
        return end;
    }

    /// Cuts the corner before a piece, if that may make the path noticeably shorter. Returns whether it was cut.
    bool cut(std::size_t corner)
    {
        const Piece &before = pieces_[corner - 1], &after = pieces_[corner];
        if (!before.is_straight || !after.is_straight) return false;
        const Stop begin = before.stops.front(), middle = before.stops.back(), end = after.stops.back();
        const double old_length = before.length + after.length, gain = old_length - (end.ground - begin.ground).norm();
        if (gain < smallest_gain * so_far_.back()) return false;
        const auto between = [&](const Stop& other, double part) -> Vec3 {
            return middle.ground + part * (other.ground - middle.ground);
        };
        const Vec2 first_way = (middle.ground - begin.ground).head<2>(),
                   last_way = (end.ground - middle.ground).head<2>();
        const double first_yaw = std::atan2(first_way.y(), first_way.x()),
                     last_yaw = std::atan2(last_way.y(), last_way.x());
        double low = 0, high = 1;  // parts of both ways that the cut removes
        std::optional<std::array<Piece, 3>> best;
        for (int k = 0; k < bisections; ++k) {
            const double part = (low + high) / 2;
            auto first = straight(begin, {between(begin, part), first_yaw}, true);
            auto second = first ? straight(first->stops.back(), {between(end, part), last_yaw}, true) : std::nullopt;
            auto third = second ? straight(second->stops.back(), end) : std::nullopt;
            if (third && first->length + second->length + third->length < old_length) {
                best = {std::move(*first), std::move(*second), std::move(*third)};
                low = part;
            } else {
                high = part;
            }
        }
        if (!best) return false;
        pieces_[corner - 1] = std::move((*best)[0]);
        pieces_[corner] = std::move((*best)[2]);
        pieces_.insert(pieces_.begin() + std::ptrdiff_t(corner), std::move((*best)[1]));
        return true;
    }

    StraightWays ways_;
    const std::vector<Stop>& stops_;
    const std::vector<double>& lengths_;
    std::vector<double> so_far_;  ///< length of the path up to each stop, m
    std::vector<Piece> pieces_;
};

}  // namespace

double length_between(std::span<const Stop> stops)
{
    double out = 0;
    for (std::size_t k = 1; k < stops.size(); ++k) out += (stops[k].ground - stops[k - 1].ground).norm();
    return out;
}

ShortPath shortened(const ReachGraph::Impl& graph, const std::vector<Stop>& stops, const std::vector<double>& lengths)
{
    return Shortener(graph, stops, lengths).run();
}

}  // namespace spawnfield
