#include "base/parallel.h"
#include "base/rotation.h"
#include "column/columns.h"
#include "free_space/footprint.h"
#include "query/stand_judge.h"

#include <spawnfield/error.h>
#include <spawnfield/frames.h>
#include <spawnfield/repair.h>

#include <algorithm>
#include <cmath>
#include <deque>
#include <numbers>

namespace spawnfield {
namespace {

constexpr int most_headings = 64;

struct GridColumn {
    int i, j;
    double distance;  ///< from the pose, horizontally, m
};

/// Returns the columns of the grid, the nearest first. Equally near ones are in the order of j, then of i.
std::vector<GridColumn> columns_within(double radius, double step)
{
    const int most = int(radius / step) + 1;
    const auto squared = [](const GridColumn& at) { return std::int64_t(at.i) * at.i + std::int64_t(at.j) * at.j; };
    std::vector<GridColumn> out;
    for (int j = -most; j <= most; ++j)
        for (int i = -most; i <= most; ++i) {
            GridColumn at{i, j, 0};
            at.distance = step * std::sqrt(double(squared(at)));
            if (at.distance <= radius + touch_tolerance) out.push_back(at);
        }
    std::stable_sort(out.begin(), out.end(),
                     [&](const GridColumn& a, const GridColumn& b) { return squared(a) < squared(b); });
    return out;
}

/// Returns the turns to all headings, rad: 0 first, then from small to large ones, to the left before to the right.
std::vector<double> turns_of(int headings)
{
    std::vector<double> out{0};
    for (int k = 1; 2 * k <= headings; ++k) {
        out.push_back(heading_of(k, headings));
        if (2 * k < headings) out.push_back(-heading_of(k, headings));
    }
    return out;
}

/// Returns the options with a step. Throws ArgumentError for values beyond their limits.
RepairOptions completed(RepairOptions options, const Robot& robot)
{
    const auto require = [](bool is_good, const char* name, double value, const char* limit) {
        if (!is_good) throw ArgumentError("nearest_valid", name, value, limit);
    };
    require(options.radius > 0 && std::isfinite(options.radius), "radius", options.radius, "> 0 m");
    require(options.headings >= 1 && options.headings <= most_headings, "headings", options.headings, "1 .. 64");
    if (!options.step) options.step = auto_repair_step(robot, options.radius);
    require(*options.step >= options.radius / largest_repair_grid && std::isfinite(*options.step), "step",
            *options.step, "at least a thousandth of radius");
    return options;
}

/// What all searches of a query share.
struct RepairQuery {
    const Judge::Impl& judge;
    const RepairOptions options;
    const std::vector<GridColumn> columns;
    const std::vector<double> turns;

    RepairQuery(const Judge& judge_, const RepairOptions& options_)
        : judge(judge_.impl()), options(completed(options_, judge_.robot())),
          columns(columns_within(options.radius, *options.step)), turns(turns_of(options.headings))
    {
    }
};

/// Finds repairs, one after another, for one thread. Makes and judges the grid poses of one pose.
class RepairSearch {
public:
    explicit RepairSearch(const RepairQuery& query) : query_(query), facings_(query.turns.size())
    {
        if (query.options.stance == Stance::Settled) stand_.emplace(query.judge);
    }

    Repair find(const Pose& pose)
    {
        if (!pose.position.allFinite() || !pose.rotation.allFinite())
            throw ArgumentError("nearest_valid", "the pose has numbers that are not finite");
        out_ = {};
        position_ = pose.position;
        stand_ ? expect_settled(pose) : expect_level(pose);
        search(0, 1);
        if (!out_.pose) search(1, facings_.size());
        return out_;
    }

private:
    struct Facing {
        double yaw = 0;
        Mat3 rotation = Mat3::Identity();  ///< of level poses
    };

    /// Returns a yaw that was turned, in [-pi, pi].
    double turned(double yaw, std::size_t k) const
    {
        return k == 0 ? yaw : std::remainder(yaw + query_.turns[k], 2 * std::numbers::pi);
    }

    void expect_settled(const Pose& pose)
    {
        const double yaw = yaw_of(pose.rotation);
        for (std::size_t k = 0; k < facings_.size(); ++k) facings_[k].yaw = turned(yaw, k);
        // From its layer, the level robot is raised by at most max_height, and then turns. Its origin rises or sinks by
        // at most the robot's size while it turns.
        const double size = 2 * query_.judge.settler().reach();
        const double most_raised = query_.judge.options.max_height + query_.judge.options.stand.lift;
        layers_ = {position_.z() - query_.options.radius - most_raised - size,
                   position_.z() + query_.options.radius + size};
    }

    void expect_level(const Pose& pose)
    {
        rpy_ = rpy_from(pose.rotation);
        for (std::size_t k = 0; k < facings_.size(); ++k) {
            facings_[k].yaw = turned(rpy_.yaw, k);
            facings_[k].rotation = k == 0 ? pose.rotation : rotation_from({rpy_.roll, rpy_.pitch, facings_[k].yaw});
        }
        set_heights(pose);
        const auto [lowest, highest] = std::minmax_element(heights_.begin(), heights_.end());
        layers_ = {position_.z() - query_.options.radius - *highest, position_.z() + query_.options.radius - *lowest};
    }

    /// Sets the heights of level grid poses above a layer: that of the pose, and that at which the robot is clear of
    /// level ground.
    void set_heights(const Pose& pose)
    {
        constexpr double clear_of_ground = 0.1;  // m, as auto_offset()
        const Map& map = query_.judge.map;
        heights_.clear();
        read_column(map.geometry, position_.x(), position_.y(), column_);
        const std::optional<Ground> ground = ground_below(column_, position_.z());
        if (ground && position_.z() - ground->height <= query_.judge.options.max_height + touch_tolerance)
            heights_.push_back(position_.z() - ground->height);
        heights_.push_back(clear_of_ground - lowest_point(query_.judge.robot, pose.rotation));
    }

    /// Judges the grid poses with these facings, until no nearer one can be valid.
    void search(std::size_t first, std::size_t end)
    {
        const Geometry& geometry = query_.judge.map.geometry;
        for (const GridColumn& at : query_.columns) {
            if (out_.pose && at.distance > out_.distance + touch_tolerance) return;
            const Vec2 place = position_.head<2>() + *query_.options.step * Vec2(at.i, at.j);
            read_column(geometry, place.x(), place.y(), column_);
            for (const double layer :
                 heights_within(heights_within(column_.layers, query_.judge.map.z_limits), layers_))
                for (std::size_t k = first; k < end; ++k)
                    stand_ ? try_settled(at, place, layer, k) : try_level(at, place, layer, k);
        }
    }

    void try_level(const GridColumn& at, const Vec2& place, double layer, std::size_t k)
    {
        for (const double height : heights_) {
            const Vec3 origin(place.x(), place.y(), layer + height);
            if (!would_win(at, origin.z(), k)) continue;
            PoseJudge& judge = judge_at(k);
            judge.set_rotation(facings_[k].rotation);
            const Judgement judged = judge.judge_as_given(column_, origin);
            count(judged.exact_check);
            if (judged.verdict == Verdict::Valid) take(at, {origin, facings_[k].yaw, rpy_.roll, rpy_.pitch}, k);
        }
    }

    void try_settled(const GridColumn& at, const Vec2& place, double layer, std::size_t k)
    {
        const SettledPose pose = stand_->judge(column_, {place.x(), place.y(), layer}, facings_[k].yaw);
        count(pose.exact_check);
        if (pose.verdict != Verdict::Valid) return;
        const Vec3 origin = pose.lifted(query_.judge.options.stand.lift).position;
        if (would_win(at, origin.z(), k)) take(at, {origin, pose.yaw, pose.roll, pose.pitch}, k);
    }

    /// Returns the judge of level poses with a facing. Each facing has its own, because another rotation costs time.
    PoseJudge& judge_at(std::size_t k)
    {
        while (judges_.size() <= k) judges_.emplace_back(query_.judge, 0);
        return judges_[k];
    }

    void count(bool is_exact)
    {
        ++out_.tried;
        out_.exact_checks += is_exact;
    }

    /// Returns the distance of a grid pose, m.
    double distance(const GridColumn& at, double z) const { return std::hypot(at.distance, z - position_.z()); }

    /// Returns whether a grid pose would be the result if it is valid.
    bool would_win(const GridColumn& at, double z, std::size_t k) const
    {
        const double far = distance(at, z), turn = std::abs(query_.turns[k]);
        if (far > query_.options.radius + touch_tolerance) return false;
        if (!out_.pose || far < out_.distance - touch_tolerance) return true;
        return far <= out_.distance + touch_tolerance && turn < std::abs(out_.turn);
    }

    void take(const GridColumn& at, const Spawn& pose, std::size_t k)
    {
        out_.pose = pose;
        out_.distance = distance(at, pose.position.z());
        out_.turn = query_.turns[k];
    }

    const RepairQuery& query_;
    std::optional<StandJudge> stand_;  ///< nothing: level poses
    std::deque<PoseJudge> judges_;     ///< of level poses, one for each facing; a deque never moves its elements
    // These belong to the pose that is repaired:
    Repair out_;
    Vec3 position_ = Vec3::Zero();
    Rpy rpy_;
    std::vector<Facing> facings_;  ///< one for each turn
    std::vector<double> heights_;  ///< of level grid poses above their layers, m
    ZRange layers_;                ///< grid poses on other layers are too far away
    Column column_;
};

}  // namespace

double auto_repair_step(const Robot& robot, double radius)
{
    const Bounds box = robot.bounds();
    const double side = (box.max - box.min).head<2>().minCoeff();
    return std::max(std::min(radius / 20, side / 4), radius / 50);
}

Repair nearest_valid(const Judge& judge, const Pose& pose, const RepairOptions& options)
{
    const RepairQuery query(judge, options);
    return RepairSearch(query).find(pose);
}

RepairList repair_poses(const Judge& judge, std::span<const Pose> poses, std::span<const Judgement> judgements,
                        const RepairOptions& options)
{
    if (judgements.size() != poses.size())
        throw ArgumentError("repair_poses", "size of judgements", double(judgements.size()), "as many as poses");
    const RepairQuery query(judge, options);
    std::vector<std::size_t> broken;
    for (std::size_t i = 0; i < poses.size(); ++i)
        if (judgements[i].verdict != Verdict::Valid) broken.push_back(i);
    RepairList out{.options = query.options, .repairs = std::vector<std::optional<Repair>>(poses.size())};
    PerThread<RepairSearch> searches{[&] { return RepairSearch(query); }};
    parallel_for(broken.size(), options.threads, options.progress,
                 [&](std::size_t k) { out.repairs[broken[k]] = searches.local().find(poses[broken[k]]); });
    for (const std::size_t i : broken) {
        const Repair& repair = *out.repairs[i];
        ++(repair.pose ? out.repaired : out.unrepaired);
        out.turned += repair.pose && repair.turn != 0;
    }
    return out;
}

}  // namespace spawnfield
