#include "base/number.h"
#include "fleet/kind_poses.h"
#include "fleet/placed_robots.h"
#include "query/draw.h"

#include <spawnfield/error.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>

namespace spawnfield {
namespace {

// Draws end when a batch of `fair_batch` poses or more gives fewer robots than this share of its poses. Then the raster
// is examined.
constexpr double least_share = 0.02;
constexpr std::size_t smallest_batch = 16, fair_batch = 256, largest_batch = 1 << 16;
constexpr double convoy_shift = 0.1;  // of the spacing, between the starts that are tried

/// Robots that are placed together: all or none.
struct Group {
    const Formation* formation;
    std::vector<std::size_t> kinds;  ///< of each robot
};

void check_fleet(std::span<const FleetKind> kinds, const FleetOptions& options)
{
    constexpr const char* function = "place_fleet";
    if (kinds.empty()) throw ArgumentError(function, "kinds is empty, needs at least one");
    for (const FleetKind& kind : kinds) {
        const std::string of_kind = " of kind \"" + kind.name + "\"";
        if (kind.count && (*kind.count < 1 || *kind.count > max_spawns))
            throw ArgumentError(function, "count" + of_kind, double(*kind.count), "1 .. " + std::to_string(max_spawns));
        if (!kind.count && (kind.formation || options.formation))
            throw ArgumentError(function, "count" + of_kind + " is missing, but a formation needs it");
        if (kind.formation && options.formation)
            throw ArgumentError(function, "formation" + of_kind + " is given, but the whole fleet has one, too");
        if (kind.fill_step && (!(*kind.fill_step > 0) || !std::isfinite(*kind.fill_step)))
            throw ArgumentError(function, "fill_step" + of_kind, *kind.fill_step, "> 0 m");
        if (kind.spawns.place.has_limits() || !kind.spawns.place.facing.empty() ||
            !kind.spawns.measures.prefer.empty() || !kind.spawns.measures.columns.empty())
            throw ArgumentError(function, "spawns" + of_kind + " have rules of place, which fleets do not have");
        if (kind.judge.map().hash != kinds[0].judge.map().hash)
            throw ArgumentError(function, "judge" + of_kind + " is for another map than that of the first kind");
    }
}

/// Returns the items in a random order (Fisher and Yates).
template <class Item>
void shuffle(std::vector<Item>& items, std::uint64_t seed, std::uint64_t stream)
{
    Draw random(seed, stream);
    for (std::size_t i = items.size(); i > 1; --i)
        std::swap(items[i - 1], items[std::size_t(random.unit() * double(i))]);
}

class Placer {
public:
    Placer(std::span<const FleetKind> kinds, const FleetOptions& options)
        : kinds_(kinds), options_(options), placed_(kinds, options), found_(kinds.size())
    {
        out_.kinds.resize(kinds.size());
        // Draws and rasters report the share of all robots, and can be ended by an exception of the progress.
        if (options.progress) options_.progress = [this, &options](double) { options.progress(share_); };
        for (const FleetKind& kind : kinds) poses_.emplace_back(kind, options_);
    }
    Placer(const Placer&) = delete;  // options_.progress refers to this object

    Fleet run()
    {
        try {
            for (const Group& group : groups()) place_group(group);
            for (const std::size_t kind : in_order()) {
                if (kinds_[kind].formation || options_.formation) continue;
                draw(kind);
                if (is_missing(kind)) search_raster(kind);
            }
        } catch (const FleetStopped&) {
            out_.is_stopped = true;
        }
        for (std::size_t kind = 0; kind < kinds_.size(); ++kind) append_robots(kind);
        return std::move(out_);
    }

private:
    void end_if_stopped() const
    {
        if (options_.is_stopped()) throw FleetStopped{};
    }

    /// Returns the formations, those at a given place first.
    std::vector<Group> groups() const
    {
        std::vector<Group> out;
        const auto add = [&](const Formation& formation, std::size_t first, std::size_t end) {
            Group& group = out.emplace_back();
            group.formation = &formation;
            for (std::size_t kind = first; kind < end; ++kind)
                group.kinds.insert(group.kinds.end(), *kinds_[kind].count, kind);
        };
        if (options_.formation) add(*options_.formation, 0, kinds_.size());
        for (std::size_t kind = 0; kind < kinds_.size(); ++kind)
            if (kinds_[kind].formation) add(*kinds_[kind].formation, kind, kind + 1);
        std::stable_partition(out.begin(), out.end(), [](const Group& group) { return is_fixed(*group.formation); });
        return out;
    }

    static bool is_fixed(const Formation& formation)
    {
        return formation.at || formation.form == Formation::Form::Convoy;
    }

    /// Returns the kinds in the order in which they are placed.
    std::vector<std::size_t> in_order() const
    {
        std::vector<std::size_t> out(kinds_.size());
        std::iota(out.begin(), out.end(), std::size_t{0});
        const auto reach = [&](std::size_t kind) { return reach_of(kinds_[kind].judge.robot()); };
        std::stable_sort(out.begin(), out.end(), [&](std::size_t a, std::size_t b) {
            const bool fills_a = !kinds_[a].count, fills_b = !kinds_[b].count;
            return fills_a != fills_b ? fills_b : reach(a) > reach(b);
        });
        return out;
    }

    bool is_missing(std::size_t kind) const { return !kinds_[kind].count || found_[kind].size() < *kinds_[kind].count; }

    void add(std::size_t kind, const Stand& stand)
    {
        placed_.add(kind, stand.spawn);
        found_[kind].push_back(stand);
        std::size_t wanted = 0, found = 0;
        for (std::size_t k = 0; k < kinds_.size(); ++k) {
            wanted += kinds_[k].count.value_or(0);
            found += found_[k].size();
        }
        if (wanted > 0) share_ = std::min(1.0, double(found) / double(wanted));
        if (options_.progress) options_.progress(share_);
    }

    /// Draws poses of a kind until there are enough robots, or until few of the poses have room.
    void draw(std::size_t kind)
    {
        FleetKindResult& result = out_.kinds[kind];
        std::size_t batch = smallest_batch;
        for (std::uint64_t number = 0; is_missing(kind); ++number, batch = std::min(2 * batch, largest_batch)) {
            if (kinds_[kind].count && number == 0)
                batch = std::clamp(2 * *kinds_[kind].count, smallest_batch, largest_batch);
            const std::vector<Stand> stands = poses_[kind].draw(batch, stream(kind, number), result);
            const std::size_t before = found_[kind].size();
            for (const Stand& stand : stands) {
                if (!is_missing(kind)) break;
                ++result.draws;
                const PlacedRobots::Room room = placed_.room_for(kind, stand.spawn);
                result.overlapping += room == PlacedRobots::Room::Overlaps;
                result.too_close += room == PlacedRobots::Room::TooClose;
                if (room == PlacedRobots::Room::Clear) add(kind, stand);
            }
            if (is_missing(kind)) end_if_stopped();
            const bool gives_few = double(found_[kind].size() - before) < least_share * double(batch);
            if (stands.size() < batch || (batch >= fair_batch && gives_few)) return;
        }
    }

    /// Examines all poses of the raster, in a random order for each heading.
    void search_raster(std::size_t kind)
    {
        FleetProof proof{.step = poses_[kind].step(), .headings = poses_[kind].headings()};
        for (std::size_t heading = 0; heading < proof.headings; ++heading) {
            std::vector<Stand> stands = poses_[kind].raster(heading, proof, out_.kinds[kind]);
            shuffle(stands, options_.seed, stream(kind, shuffles + heading));
            for (const Stand& stand : stands) {
                if (placed_.room_for(kind, stand.spawn) == PlacedRobots::Room::Clear) add(kind, stand);
                if (!is_missing(kind)) return;
                end_if_stopped();
            }
        }
        out_.kinds[kind].proof = proof;
    }

    void place_group(const Group& group)
    {
        const Formation& formation = *group.formation;
        if (formation.form == Formation::Form::Convoy) return place_convoy(group);
        if (formation.at)
            return place_at(
                group, formation_slots(formation, group.kinds.size(), *formation.at, formation.heading.value_or(0)));
        place_anywhere(group);
    }

    void place_at(const Group& group, const std::vector<FormationSlot>& slots)
    {
        std::string why;
        if (!try_slots(group, slots, &why)) missing(group, why);
    }

    void missing(const Group& group, const std::string& why)
    {
        for (const std::size_t kind : group.kinds) out_.kinds[kind].why = why;
    }

    void place_convoy(const Group& group)
    {
        const Formation& formation = *group.formation;
        std::string first_why;
        for (int shift = 0;; ++shift) {
            const auto slots = convoy_slots(formation, group.kinds.size(), shift * convoy_shift * formation.spacing);
            if (slots.empty()) break;
            std::string why;
            if (try_slots(group, slots, &why)) return;
            if (shift == 0) first_why = why;
        }
        if (first_why.empty())
            return missing(group, "the path has a length of " + rounded(path_length(formation)) + " m, but " +
                                      std::to_string(group.kinds.size()) + " robots need " +
                                      rounded(double(group.kinds.size() - 1) * formation.spacing) + " m");
        missing(group, "there is no place for all robots along the path; at its start, " + first_why);
    }

    /// Draws places for the first robot of a formation, then tries those of its raster.
    void place_anywhere(const Group& group)
    {
        constexpr std::size_t most_tries = 4096;
        const std::size_t kind = group.kinds[0];
        FleetKindResult& result = out_.kinds[kind];
        for (std::size_t batch = smallest_batch, number = 0; result.draws < most_tries; batch *= 2, ++number) {
            const std::vector<Stand> stands = poses_[kind].draw(batch, stream(kind, number), result,
                                                                group.formation->heading);
            for (const Stand& stand : stands) {
                ++result.draws;
                if (try_around(group, stand)) return;
            }
            end_if_stopped();
            if (stands.size() < batch) break;
        }
        FleetProof proof{.step = poses_[kind].step(), .headings = KindPoses::random_headings};
        if (group.formation->heading && group.formation->form != Formation::Form::Circle) proof.headings = 1;
        for (std::size_t heading = 0; heading < proof.headings; ++heading) {
            std::vector<Stand> all = poses_[kind].raster_at(
                group.formation->heading.value_or(0) + heading_of(int(heading), int(proof.headings)), proof, result);
            shuffle(all, options_.seed, stream(kind, shuffles + heading));
            for (const Stand& stand : all)
                if (try_around(group, stand)) return;
        }
        result.proof = proof;
        missing(group, "all robots have room at none of the " + std::to_string(proof.valid) +
                           " valid poses of the first robot on a raster with steps of " + rounded(proof.step) +
                           " m and " + std::to_string(proof.headings) + " headings");
    }

    /// Tries a formation whose first robot is at this pose.
    bool try_around(const Group& group, const Stand& first)
    {
        const Formation& formation = *group.formation;
        const std::size_t count = group.kinds.size();
        const FormationSlot start = formation_slots(formation, count, {}, 0)[0];
        const double heading = first.spawn.yaw - start.yaw;
        const FormationSlot turned = formation_slots(formation, count, {}, heading)[0];
        const Vec3& at = first.spawn.position;
        const StartPlace middle{at.x() - turned.x, at.y() - turned.y, first.ground};
        return try_slots(group, formation_slots(formation, count, middle, heading), nullptr);
    }

    /// Places all robots of a formation, or none. Then, `why` gets the reason.
    bool try_slots(const Group& group, const std::vector<FormationSlot>& slots, std::string* why)
    {
        const std::size_t before = placed_.size();
        std::vector<Stand> stands;
        std::optional<double> level;  // of the first robot's ground
        for (std::size_t i = 0; i < slots.size(); ++i) {
            end_if_stopped();
            const std::size_t kind = group.kinds[i];
            FormationSlot slot = slots[i];
            if (!slot.z) slot.z = level;
            const auto fail = [&](const std::string& reason) {
                if (why != nullptr)
                    *why = name_in(group, i) + " has no place at " + rounded(slot.x) + ", " + rounded(slot.y) + ": " +
                           reason;
                placed_.shrink(before);
                return false;
            };
            const Standing standing = poses_[kind].stand_at(slot);
            out_.kinds[kind].exact_checks += standing.exact_checks;
            if (!standing.stand) return fail(standing.why);
            const PlacedRobots::Room room = placed_.room_for(kind, standing.stand->spawn);
            if (room == PlacedRobots::Room::Overlaps) return fail("it overlaps another robot");
            if (room == PlacedRobots::Room::TooClose) return fail("another robot is nearer than the distance");
            placed_.add(kind, standing.stand->spawn);
            stands.push_back(*standing.stand);
            if (!level) level = standing.stand->ground;
        }
        placed_.shrink(before);
        for (std::size_t i = 0; i < stands.size(); ++i) add(group.kinds[i], stands[i]);
        return true;
    }

    std::string name_of(std::size_t kind, std::size_t number) const
    {
        const FleetKind& of = kinds_[kind];
        return of.count == 1 ? of.name : of.name + "_" + std::to_string(number + 1);
    }

    std::string name_in(const Group& group, std::size_t robot) const
    {
        const std::size_t kind = group.kinds[robot];
        const auto first = std::find(group.kinds.begin(), group.kinds.end(), kind);
        return name_of(kind, robot - std::size_t(first - group.kinds.begin()));
    }

    void append_robots(std::size_t kind)
    {
        const std::vector<Stand>& stands = found_[kind];
        out_.kinds[kind].found = stands.size();
        for (std::size_t i = 0; i < stands.size(); ++i)
            out_.robots.push_back({name_of(kind, i), kind, stands[i].spawn, stands[i].rest});
    }

    static std::uint64_t stream(std::size_t kind, std::uint64_t number)
    {
        return (std::uint64_t(kind) << 32) + number;  // a kind has fewer than 2^31 batches
    }
    static constexpr std::uint64_t shuffles = std::uint64_t{1} << 31;  // streams of shuffled rasters

    const std::span<const FleetKind> kinds_;
    FleetOptions options_;
    double share_ = 0;  ///< of the robots with a count that have been placed
    PlacedRobots placed_;
    std::vector<KindPoses> poses_;
    std::vector<std::vector<Stand>> found_;  ///< by kind
    Fleet out_;
};

}  // namespace

Fleet place_fleet(std::span<const FleetKind> kinds, const FleetOptions& options)
{
    check_fleet(kinds, options);
    return Placer(kinds, options).run();
}

}  // namespace spawnfield
