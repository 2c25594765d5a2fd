#include "query/headings_judge.h"

#include <algorithm>
#include <numbers>

namespace spawnfield {

Verdict merged(const VerdictTally& tally)
{
    if (tally[std::size_t(Verdict::Valid)] > 0) return Verdict::Valid;
    return Verdict(std::max_element(tally.begin(), tally.end()) - tally.begin());
}

HeadingsJudge::HeadingsJudge(const Judge::Impl& shared, int headings, double max_height)
    : has_footing_(shared.footing.has_value())
{
    for (int k = 0; k < headings; ++k) at_heading_.emplace_back(shared, heading_of(k, headings), max_height);
    for (PoseJudge& judge : at_heading_) {
        judge.share_search(at_heading_.front());
        judge.leave_layered_cells();
    }
    if (!shared.space) return;
    every_yaw_.emplace(shared.space->impl());
    every_yaw_->set_every_yaw();
}

VerdictTally HeadingsJudge::judge(const ColumnView& column, const Vec3& position, std::uint64_t& exact_checks)
{
    VerdictTally out{};
    const auto add = [&](Verdict verdict, std::size_t count) {
        out[std::size_t(verdict)] = std::uint8_t(out[std::size_t(verdict)] + count);
    };
    Judgement on_ground;
    if (!at_heading_.front().judge_ground(column, position, on_ground)) {
        add(on_ground.verdict, at_heading_.size());
        return out;
    }
    Proof at_every_yaw = Proof::Candidate;
    if (every_yaw_)
        at_every_yaw = every_yaw_->is_pierced(column.spans, position.z()) ? Proof::Blocked
                                                                          : every_yaw_->proof_of(position);
    const bool is_free = at_every_yaw == Proof::Free;
    if (at_every_yaw == Proof::Blocked || (is_free && !has_footing_)) {
        add(is_free ? Verdict::Valid : Verdict::Collision, at_heading_.size());
        return out;
    }
    for (PoseJudge& judge : at_heading_) {
        Judgement judged = on_ground;
        if (is_free)
            judged.verdict = Verdict::Valid;
        else
            judge.judge_collision(column, position, false, judged);
        judge.judge_footing(position, judged);
        add(judged.verdict, 1);
        exact_checks += judged.exact_check;
    }
    return out;
}

}  // namespace spawnfield
