#include "base/chosen_bounds.h"
#include "query/spawning.h"

#include <spawnfield/error.h>

#include <cmath>

namespace spawnfield {
namespace {

/// Draws in a row without a spawn after which the feasible region counts as full.
constexpr std::uint64_t patience = 200000;

/// Layers of a column that were chosen, from the top.
std::vector<double> chosen_layers(const Column& column, const LayerChoice& choice)
{
    std::vector<double> out;
    const int count = int(column.layers.size());
    for (int layer = 0; layer < count; ++layer)
        if (choice.includes(layer, count)) out.push_back(column.layers[layer]);
    return out;
}

/// One pass with a fixed number of slots per column. A draw takes one slot at one point; a slot without a layer gives
/// nothing. So each layer is drawn with equal density, however many there are above each other.
class Sampler {
public:
    Sampler(const Map& map, const CollisionChecker& checker, const SampleOptions& options, std::size_t slots)
        : map_(map), options_(options), judging_(map, checker, standing(options)), box_(chosen_bounds("sample", options.bounds, map.bounds, 2)), slots_(slots),
          taken_(options.min_distance)
    {
    }

    /// False if a column had more layers than slots: then nothing that was drawn counts.
    bool run(SpawnList& out)
    {
        std::uint64_t failures = 0;
        const auto batch_size = [&](std::uint64_t draws) { return batch_for(options_.count, out.spawns.size(), draws); };
        draw_in_order(0, judging_, share_found(options_, out), batch_size, [this](std::uint64_t index, SpawnJudge& judge) { return look(index, judge); }, [&](const Candidate& candidate) {
            ++out.draws;
            ++failures;
            if (overfull_) return false;
            if (candidate.on_ground && take(candidate, out)) failures = 0;
            return out.spawns.size() < options_.count && failures < patience;
        });
        return !overfull_;
    }

private:
    static QueryOptions standing(const SampleOptions& options)
    {
        QueryOptions out = options;
        out.max_height = std::numeric_limits<double>::infinity();  // poses stand on their layer by definition
        return out;
    }

    Candidate look(std::uint64_t index, SpawnJudge& judge)
    {
        Draw draw(options_.seed, index);
        const double x = draw.uniform(box_.min.x(), box_.max.x()), y = draw.uniform(box_.min.y(), box_.max.y());
        const double slot = draw.uniform(0, double(slots_));
        Candidate out;
        out.spawn.yaw = draw_yaw(options_, draw);
        const Column column = column_at(map_.geometry, x, y);
        const std::vector<double> layers = chosen_layers(column, options_.layers);
        if (layers.size() > slots_) overfull_ = true;
        if (slot >= double(layers.size())) return out;
        out.on_ground = true;
        out.spawn.position = Vec3(x, y, layers[std::size_t(slot)] + options_.offset);
        out.clear = taken_.is_clear(out.spawn.position);
        if (!out.clear) return out;
        out.set(judge.at(y, out.spawn.yaw).at(column, x, out.spawn.position.z()));
        return out;
    }

    bool take(const Candidate& candidate, SpawnList& out)
    {
        if (!candidate.clear || !taken_.is_clear(candidate.spawn.position)) {
            ++out.too_close;
            return false;
        }
        ++out.counts[std::size_t(candidate.verdict)];
        out.exact_checks += candidate.exact_check;
        if (candidate.verdict != Verdict::Valid) return false;
        taken_.add(candidate.spawn.position);
        out.spawns.push_back(candidate.spawn);
        return true;
    }

    const Map& map_;
    const SampleOptions& options_;
    const Judging judging_;
    const Bounds box_;
    const std::size_t slots_;
    SpacedPoints taken_;
    std::atomic<bool> overfull_{false};
};

}  // namespace

SpawnList sample(const Map& map, const CollisionChecker& checker, const SampleOptions& options)
{
    check_spawn_options("sample", options);
    if (!std::isfinite(options.offset)) throw ArgumentError("sample", "offset", options.offset, "a finite number, m");
    const bool one = options.layers.kind != LayerChoice::Kind::All;
    // The map counts layers at cell centres only; where a point between them has more, all starts over with more slots.
    for (std::size_t slots = one ? 1 : std::size_t(std::max(1, map.layers));; ++slots) {
        SpawnList out;
        if (Sampler(map, checker, options, slots).run(out)) return out;
    }
}

}  // namespace spawnfield
