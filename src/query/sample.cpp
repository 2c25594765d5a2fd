#include "base/chosen_bounds.h"
#include "base/large_list.h"
#include "base/polygon2.h"
#include "query/area_index.h"
#include "query/avoid_index.h"
#include "query/cell_proofs.h"
#include "query/place_cells.h"
#include "query/place_meter.h"
#include "query/spawning.h"

#include <spawnfield/error.h>

#include <cmath>
#include <limits>
#include <numbers>
#include <utility>

namespace spawnfield {
namespace {

// The first pass draws in the whole region. It ends after `blind_patience` failures in a row, or when at most
// `least_share` of the last `blind_window` draws gave a spawn. After that, draws are made only in cells that are not
// proven full.
constexpr std::uint64_t blind_patience = 2000, blind_window = 1 << 17;
constexpr std::uint64_t settled_patience = 5000;  // the same for settled poses, for which there are no proofs
// The same with place rules. Few draws may comply with them, and draws that do not take little time.
constexpr std::uint64_t place_patience = 100000;
constexpr double least_share = 0.02;
// Cells are not split as long as more than this share of a round of draws gives a spawn.
constexpr double fair_share = 0.05;
constexpr double first_cells = 1024, most_first_cells = 65536;  // about the limits of the number of cells at first
constexpr std::size_t most_cells = 1 << 24;                     // kept at a time
// Limit of the number of proofs: `some_proofs`, or half of that if the cells that are left cover less than
// `next_to_nothing` of the region; and `proofs_per_point` for each spawn found and each avoided point.
constexpr std::size_t some_proofs = 1 << 19, proofs_per_point = 12;
constexpr double next_to_nothing = 2e-5;  // share of the region's area
constexpr double smallest_cell = 0.0001;  // m
constexpr double unknown_area = std::numeric_limits<double>::quiet_NaN();

/// The cells of a region that are not proven full. All cells have the same size, because all are split at the same
/// time. So a random point in a random cell is uniform by area.
class Cells {
public:
    Cells(const Bounds& box, double min_distance) : box_(box), size_(box.max.head<2>() - box.min.head<2>())
    {
        if (!(size_.minCoeff() >= 0)) return;  // the region is empty
        const double area = std::max(size_.x() * size_.y(), smallest_cell * smallest_cell);
        const double side = std::clamp(min_distance / std::numbers::sqrt2, std::sqrt(area / most_first_cells),
                                       std::sqrt(area / first_cells));
        cols_ = count(size_.x(), side);
        rows_ = count(size_.y(), side);
        cells_.reserve(std::size_t{cols_} * rows_);
        for (std::uint32_t row = 0; row < rows_; ++row)
            for (std::uint32_t col = 0; col < cols_; ++col) cells_.push_back({col, row});
    }

    std::size_t size() const { return cells_.size(); }
    double width() const { return size_.x() / cols_; }
    double height() const { return size_.y() / rows_; }
    double area() const { return double(cells_.size()) * width() * height(); }

    double region_area() const { return size_.x() * size_.y(); }

    Rect at(std::size_t i) const
    {
        const auto [col, row] = cells_[i];
        const auto x = [&](std::uint32_t c) { return std::min(box_.max.x(), box_.min.x() + c * width()); };
        const auto y = [&](std::uint32_t r) { return std::min(box_.max.y(), box_.min.y() + r * height()); };
        return {x(col), y(row), x(col + 1), y(row + 1)};
    }

    bool can_split() const { return std::max(cols_, rows_) < 1u << 31; }

    void split()
    {
        cols_ *= 2;
        rows_ *= 2;
        std::vector<Cell> out;
        out.reserve(4 * cells_.size());
        for (const auto& [col, row] : cells_)
            for (std::uint32_t k = 0; k < 4; ++k) out.push_back({2 * col + k % 2, 2 * row + k / 2});
        cells_ = std::move(out);
    }

    /// Keeps only the cells whose flag is 0.
    void drop(const std::vector<std::uint8_t>& flags)
    {
        std::size_t kept = 0;
        for (std::size_t i = 0; i < cells_.size(); ++i)
            if (flags[i] == 0) cells_[kept++] = cells_[i];
        cells_.resize(kept);
    }

private:
    struct Cell {
        std::uint32_t col, row;
    };
    static std::uint32_t count(double length, double side)
    {
        return std::uint32_t(std::clamp(std::ceil(length / side), 1.0, most_first_cells));
    }

    const Bounds box_;
    const Vec2 size_;
    std::uint32_t cols_ = 1, rows_ = 1;
    std::vector<Cell> cells_;
};

Pose pose_of(const Spawn& spawn) { return {spawn.position, rotation_from_rpy(spawn.roll, spawn.pitch, spawn.yaw)}; }

Bounds within(const Bounds& box, Bounds limits)
{
    limits.min.array() -= touch_tolerance;
    limits.max.array() += touch_tolerance;
    return overlap(box, limits);
}

/// One pass of sampling with a fixed number of slots per column. Each slot of a column belongs to one of its chosen
/// layers or is empty. A draw chooses a random point and a random slot, and fails if the slot is empty. So all layers
/// are drawn with the same density, no matter how many lie above each other.
class Sampler {
public:
    Sampler(const Judge& judge, const PlaceJudge& places, const PlaceMeter& meter, const SampleOptions& options,
            std::size_t slots)
        : shared_(judge.impl()), places_(places), meter_(meter), options_(options), offset_(*options.offset),
          ground_z_(overlap(shared_.map.z_limits, options.z)), area_(options.area),
          box_(overlap(chosen_bounds("sample", options.bounds, shared_.map.bounds, 2), options.area.bounds())),
          slots_(slots), avoided_(options.avoid, box_), taken_(options.min_distance)
    {
        if (places.has_limits() || meter.has_preferences())
            place_cells_.emplace(places, within(box_, shared_.map.bounds));
    }

    /// Returns false if a column had more layers than slots. Then `out` is not valid.
    bool run(SpawnList& out)
    {
        if (place_cells_) return run_in_place_cells(out);
        const auto point = [&](Draw& from) {
            const double x = from.uniform(box_.min.x(), box_.max.x()), y = from.uniform(box_.min.y(), box_.max.y());
            return Vec2(x, y);
        };
        std::size_t before = 0;
        draw(out, std::numeric_limits<std::uint64_t>::max(), point, [&](std::uint64_t draws, std::uint64_t failures) {
            if (failures >= (is_settled_ ? settled_patience : blind_patience)) return false;
            if (is_settled_ || draws % blind_window != 0) return true;
            return double(out.spawns.size() - std::exchange(before, out.spawns.size())) >
                   least_share * double(blind_window);
        });
        if (is_done(out)) return !overfull_;
        if (is_settled_)
            out.undecided_area = unknown_area;
        else
            fill(out);
        return !overfull_;
    }

private:
    /// The same in the cells in which place rules can hold. There are no proofs that a cell is full.
    bool run_in_place_cells(SpawnList& out)
    {
        out.is_full = place_cells_->is_empty();
        if (out.is_full) return true;
        draw(
            out, std::numeric_limits<std::uint64_t>::max(), [&](Draw& from) { return place_cells_->draw(from); },
            [](std::uint64_t, std::uint64_t failures) { return failures < place_patience; });
        if (!is_done(out)) out.undecided_area = place_cells_->area();
        return !overfull_;
    }

    /// Makes at most `most` draws of points. Stops earlier when all spawns are found, or when go_on(draws, failures in
    /// a row) returns false. Returns how many spawns it added.
    template <class Point, class GoOn>
    std::size_t draw(SpawnList& out, std::uint64_t most, const Point& point, const GoOn& go_on)
    {
        const std::size_t before = out.spawns.size();
        std::uint64_t failures = 0, draws = 0;
        const auto batch_size = [&](std::uint64_t so_far) {
            const auto size = std::size_t(std::min<std::uint64_t>(
                most - so_far, batch_for(options_.count, options_.min_distance, out.spawns.size(), out.draws)));
            make_room(size, out.spawns);
            return size;
        };
        const auto look_at = [&](const Draw& from, const Vec2& at, PoseJudge& judge, const ColumnView* column,
                                 Candidate& candidate) { look(from, at, judge, column, candidate); };
        const bool wants_columns = is_everywhere_ && !places_.has_limits();  // else many draws need none
        next_ = draw_in_order(next_, shared_, options_, out, taken_, wants_columns, batch_size, point, look_at,
                              [&](const Candidate& candidate) {
                                  ++out.draws;
                                  ++draws;
                                  ++failures;
                                  if (overfull_) return false;
                                  out.off_area += candidate.off_area;
                                  out.off_rules += candidate.off_rules;
                                  out.not_preferred += candidate.not_preferred;
                                  if (candidate.on_ground && take(candidate, out)) failures = 0;
                                  return out.spawns.size() < options_.count && draws < most && go_on(draws, failures);
                              });
        taken_.settle();
        return out.spawns.size() - before;
    }

    /// Allocates memory for the spawns of a batch of draws at once, and for most later ones, so that they are not
    /// copied again and again. Memory that is not used is not taken from the system.
    void make_room(std::size_t draws, std::vector<Spawn>& spawns) const
    {
        const std::size_t needed = std::min(spawns.size() + draws, options_.count);
        if (needed > spawns.capacity()) reserve_large(spawns, std::min(4 * needed, options_.count));
    }

    /// Draws in the cells that are not proven full, and splits these cells again and again. Ends when all spawns are
    /// found, when no cell is left, or when more proofs are not worth their time.
    void fill(SpawnList& out)
    {
        Cells cells(within(box_, shared_.map.bounds), options_.min_distance);
        CellProofs proofs(shared_, options_, area_, taken_.before(), avoided_);
        std::size_t proofs_made = 0;
        const auto point = [&](Draw& from) {
            const Rect cell = cells.at(std::min(cells.size() - 1, std::size_t(from.unit() * double(cells.size()))));
            const double x = from.uniform(cell.low_x, cell.high_x), y = from.uniform(cell.low_y, cell.high_y);
            return Vec2(x, y);
        };
        for (bool is_last = false; !is_done(out);) {
            proofs_made += cells.size();
            drop_closed(cells, proofs, out);
            if (is_last || cells.size() == 0) break;
            const std::size_t round = std::max<std::size_t>(256, cells.size());
            std::size_t found = round;
            while (!is_done(out) && double(found) > fair_share * double(round))
                found = draw(out, round, point, [](std::uint64_t, std::uint64_t) { return true; });
            const bool is_nearly_decided = cells.area() < next_to_nothing * cells.region_area();
            const std::size_t affordable = some_proofs / (is_nearly_decided ? 2 : 1) +
                                           proofs_per_point * (out.spawns.size() + avoided_.size());
            const bool is_smallest = std::max(cells.width(), cells.height()) < 2 * smallest_cell || !cells.can_split();
            if (!is_smallest && 4 * cells.size() <= most_cells && proofs_made + 4 * cells.size() <= affordable)
                cells.split();
            else
                is_last = double(found) < least_share * double(round) || proofs_made > affordable;
        }
        if (is_done(out)) return;
        out.undecided_area = cells.area();
        out.is_full = cells.size() == 0;
    }

    bool is_done(SpawnList& out) const
    {
        if (overfull_ || out.spawns.size() == options_.count) return true;
        out.is_stopped = is_stopped(options_);
        if (out.is_stopped) out.undecided_area = unknown_area;
        return out.is_stopped;
    }

    /// Drops the cells in which, by proof, no further spawn fits.
    void drop_closed(Cells& cells, CellProofs& proofs, const SpawnList& out) const
    {
        constexpr std::size_t chunk = 64;
        proofs.set_half_cell(cells.width() / 2, cells.height() / 2);
        std::vector<std::uint8_t> flags(cells.size());
        parallel_for((flags.size() + chunk - 1) / chunk, options_.threads, share_found(options_, out),
                     [&](std::size_t c) {
                         if (is_stopped(options_)) return;
                         for (std::size_t i = c * chunk; i < std::min(flags.size(), (c + 1) * chunk); ++i) {
                             const Rect cell = cells.at(i);
                             flags[i] = proofs.is_closed(cell);
                         }
                     });
        cells.drop(flags);
    }

    struct ChosenLayer {
        double height;
        bool is_double_ground;  ///< as counted in SpawnList
    };

    /// Returns the layer in a slot, if there is one. The slots of a column contain, from the top, its layers that are
    /// ground, chosen by the options and in the area.
    std::optional<ChosenLayer> layer_in(std::size_t slot, const ColumnView& column, const Vec2& at)
    {
        std::optional<ChosenLayer> out;
        double above = std::numeric_limits<double>::infinity();  // height of the chosen layer above
        std::size_t used = 0;
        const std::span<const double> heights = heights_within(column.layers, ground_z_);
        const int count = int(heights.size());
        for (int layer = 0; layer < count; ++layer) {
            const double height = heights[std::size_t(layer)];
            if (!options_.layers.includes(layer, count) || (!is_everywhere_ && !area_.contains(at, height))) continue;
            if (used++ == slot) out = ChosenLayer{height, above - height <= double_ground};
            above = height;
        }
        if (used > slots_) overfull_ = true;
        return out;
    }

    void look(Draw from, const Vec2& at, PoseJudge& judge, const ColumnView* known_column, Candidate& out)
    {
        const double slot = from.uniform(0, double(slots_));
        out.spawn.yaw = draw_yaw(options_, from);
        out.off_area = !is_everywhere_ && !area_.contains(at);
        if (out.off_area) return;
        out.off_rules = !places_.is_at_distances(at);
        if (out.off_rules) return;
        const ColumnView column = known_column != nullptr ? *known_column : ColumnView(judge.column_at(at));
        const std::optional<ChosenLayer> layer = layer_in(std::size_t(slot), column, at);
        if (!layer) return;
        out.on_ground = true;
        out.on_double_ground = layer->is_double_ground;
        const Vec3 ground(at.x(), at.y(), layer->height);
        if (places_.has_facing()) out.spawn.yaw = places_.facing_yaw(ground);
        if (is_settled_)
            settle(column, ground, from, out);
        else
            judge_level(column, ground, judge, out);
        if (meter_.has_preferences() && out.verdict == Verdict::Valid && !out.off_rules && out.clear)
            out.not_preferred = !(from.unit() < meter_.preference(pose_of(out.spawn), out.rest.margin));
    }

    /// Judges a level robot above the ground.
    void judge_level(const ColumnView& column, const Vec3& ground, PoseJudge& judge, Candidate& out) const
    {
        out.spawn.position = ground + offset_ * Vec3::UnitZ();
        if (!is_clear(out, avoided_, taken_)) return;
        judge.set_rotation(out.spawn.yaw);
        const Judgement judgement = judge.judge(column, out.spawn.position);
        out.set(judgement);
        if (judgement.verdict != Verdict::Valid || !places_.has_limits()) return;
        const PlaceJudge::GroundPoint below{{ground.x(), ground.y(), judgement.ground->height}, judgement.ground->part};
        out.off_rules = !places_.complies(pose_of(out.spawn), std::span(&below, 1));
    }

    /// Lets a candidate down at a place.
    void settle(const ColumnView& column, const Vec3& place, Draw& from, Candidate& out)
    {
        let_down(stand_judges_.local(), column, place, shared_.options.stand.lift, options_, from, out);
        is_clear(out, avoided_, taken_);
    }

    bool take(const Candidate& candidate, SpawnList& out)
    {
        if (candidate.off_rules || candidate.not_preferred) {
            out.exact_checks += candidate.exact_checks;
            return false;
        }
        if (candidate.near_avoided) {
            ++out.near_avoided;
            return false;
        }
        if (!candidate.clear || !taken_.is_still_clear(candidate.spawn.position)) {
            ++out.too_close;
            return false;
        }
        ++out.counts[candidate.verdict];
        out.on_double_ground += candidate.on_double_ground;
        out.exact_checks += candidate.exact_checks;
        if (candidate.verdict != Verdict::Valid) return false;
        taken_.add(candidate.spawn.position);
        add_spawn(candidate, out);
        return true;
    }

    StandJudge stand_judge() const
    {
        if (!places_.has_limits()) return StandJudge(shared_, options_.is_reachable);
        return StandJudge(shared_, options_.is_reachable, [this](const SettledPose& pose) {
            return places_.complies(pose, shared_.options.stand.lift);
        });
    }

    const Judge::Impl& shared_;
    const PlaceJudge& places_;
    const PlaceMeter& meter_;
    const SampleOptions& options_;
    const double offset_;
    const bool is_settled_ = options_.stance == Stance::Settled;
    mutable PerThread<StandJudge> stand_judges_{[this] { return stand_judge(); }};  ///< only for settled poses
    const ZRange ground_z_;                                                         ///< layers beyond it are not ground
    const AreaIndex area_;
    const bool is_everywhere_ = area_.is_everywhere();
    const Bounds box_;
    std::optional<PlaceCells> place_cells_;  ///< only with place rules
    const std::size_t slots_;
    const AvoidIndex avoided_;
    TakenPoints taken_;
    std::uint64_t next_ = 0;  ///< number of the next draw
    std::atomic<bool> overfull_{false};
};

/// Measures the columns of a list of spawns.
void measure_columns(const PlaceMeter& meter, const SampleOptions& options, SpawnList& out)
{
    for (const PlaceQuantity quantity : meter.columns()) {
        std::vector<double> values(out.spawns.size());
        parallel_for(values.size(), options.threads, {}, [&](std::size_t i) {
            const SpawnRest rest = out.rests.empty() ? SpawnRest{} : out.rests[i];
            values[i] = meter.measure(quantity, pose_of(out.spawns[i]), rest.tilt, rest.margin);
        });
        out.columns.push_back({quantity, std::move(values)});
    }
}

}  // namespace

SpawnList sample(const Judge& judge, const SampleOptions& wanted)
{
    check_spawn_options("sample", wanted);
    check_ground("sample", wanted.z, wanted.stance, wanted.offset);
    check_heading("sample", wanted.heading, wanted.stance);
    check_filter("sample", wanted.is_reachable, wanted.stance);
    if (!wanted.place.facing.empty() && (wanted.heading || wanted.random_yaw))
        throw ArgumentError("sample",
                            "place.facing is given together with a heading rule or a random yaw, which also "
                            "choose the yaw; leave one of them out");
    const PlaceJudge places(judge.map().geometry, judge.robot(), wanted.place, wanted.measures.sensor_height);
    const PlaceMeter meter("sample", judge.map().geometry, judge.robot(), wanted.measures,
                           wanted.stance == Stance::Settled);
    SampleOptions options = wanted;
    options.offset = wanted.offset.value_or(auto_offset(judge.robot()));
    if (options.stance == Stance::Settled)
        judge.impl().settler();  // throws if the obstacles are voxels
    else
        check_offset("sample", *options.offset, judge.options().max_height);
    const bool one = options.layers.kind != LayerChoice::Kind::All;
    // The map counts layers at cell centres only. If a point between centres has more layers, sampling starts again
    // with one more slot.
    for (std::size_t slots = one ? 1 : std::size_t(std::max(1, judge.map().layers));; ++slots) {
        SpawnList out = empty_list(options);
        if (!Sampler(judge, places, meter, options, slots).run(out)) continue;
        measure_columns(meter, options, out);
        return out;
    }
}

}  // namespace spawnfield
