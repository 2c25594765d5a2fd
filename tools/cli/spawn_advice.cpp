#include "spawn_advice.h"

#include "numbers.h"

#include <algorithm>

namespace spawnfield::cli {
namespace {

/// Returns the changes after which fewer poses may have this verdict.
std::vector<std::string> changes_against(Verdict verdict, const QueryArgs& args, bool is_search)
{
    const bool is_settled = args.is_settled();
    switch (verdict) {
    case Verdict::Steep: return {"a larger --max-slope"};
    case Verdict::Unstable:
        if (!is_settled) return {"a larger --max-slope"};
        return {"a smaller --min-stability", "a larger --friction", "a larger --max-tilt"};
    case Verdict::Obstructed: return {args.drop ? "a smaller --drop or --lift" : "a smaller --lift"};
    case Verdict::Unreachable: return {"a choice of more islands"};
    case Verdict::Aerial:  // draws of a search are aerial for another reason, see change_of_heights()
        if (!is_search) return {"a larger --max-height"};
        break;
    default: break;
    }
    return {};
}

/// Appends the changes against the verdicts of at least a twentieth of the judged poses, the most frequent one first.
void add_changes(std::vector<std::string>& changes, const QueryArgs& args, const Shortfall& shortfall)
{
    constexpr std::uint64_t share = 20;
    const VerdictCounts& counts = shortfall.counts;
    std::vector<Verdict> verdicts(all_verdicts.begin(), all_verdicts.end());
    std::stable_sort(verdicts.begin(), verdicts.end(), [&](Verdict a, Verdict b) { return counts[a] > counts[b]; });
    for (const Verdict verdict : verdicts) {
        if (counts[verdict] == 0 || counts[verdict] * share < counts.total()) continue;
        for (const std::string& change : changes_against(verdict, args, shortfall.is_search))
            if (std::find(changes.begin(), changes.end(), change) == changes.end()) changes.push_back(change);
    }
}

/// Returns what to do if most draws of a search are in the air; empty if they are not, or if they are too few.
std::string change_of_heights(const VerdictCounts& counts)
{
    constexpr std::uint64_t enough = 10;
    const std::uint64_t aerial = counts[Verdict::Aerial], all = counts.total();
    if (all < enough || aerial * 2 <= all) return "";
    return "draws nearer to the ground with --z LOW:HIGH (" + std::to_string(aerial) + " of " + std::to_string(all) +
           " positions were aerial)";
}

/// Returns "a, b or c".
std::string joined(const std::vector<std::string>& texts)
{
    std::string out;
    for (std::size_t i = 0; i < texts.size(); ++i) {
        if (i > 0) out += i + 1 == texts.size() ? " or " : ", ";
        out += texts[i];
    }
    return out;
}

}  // namespace

std::string spawn_advice(const QueryArgs& args, const GroundArgs& ground, const Shortfall& shortfall)
{
    std::vector<std::string> changes;
    const auto add_if = [&](bool holds, const std::string& change) {
        if (holds) changes.push_back(change);
    };
    const std::string heights = shortfall.is_search ? change_of_heights(shortfall.counts) : "";
    add_if(!heights.empty(), heights);
    add_if(shortfall.min_distance > 0, "a smaller --min-distance");
    add_if(shortfall.is_near_avoided, "a smaller --avoid-distance");
    add_if(shortfall.has_place_rules, "wider rules of place");
    add_changes(changes, args, shortfall);
    add_if(shortfall.is_search, "more --max-failures");
    add_if(!shortfall.is_search && !args.is_settled(), "another --offset");
    add_if(!ground.z.empty() && heights.empty(), "a wider --z");
    add_if(ground.floor >= 0, "another --floor");
    changes.emplace_back(!shortfall.is_search || shortfall.has_region ? "a wider --region" : "wider --bounds");
    return joined(changes);
}

}  // namespace spawnfield::cli
