#include "base/number.h"

#include <spawnfield/output_file.h>
#include <spawnfield/thesis.h>

#include <array>
#include <optional>

namespace spawnfield {
namespace {

constexpr std::array class_names{"Valid", "Invalid", "Aerial"};  // in the order of ThesisClass

/// One file of locations, written in pieces.
class LocationFile {
public:
    explicit LocationFile(const std::filesystem::path& file) : file_(file) {}

    void add(const Vec3& position)
    {
        const Vec3 p = unity_from(position);
        for (int axis = 0; axis < 3; ++axis) {
            append_number(text_, p[axis]);
            text_ += axis < 2 ? ", " : "\n";
        }
        ++lines_;
        if (text_.size() < piece) return;
        file_.write(text_);
        text_.clear();
    }

    std::uint64_t finish()
    {
        file_.write(text_);
        file_.commit();
        return lines_;
    }

private:
    static constexpr std::size_t piece = 1 << 20;
    OutputFile file_;
    std::string text_;
    std::uint64_t lines_ = 0;
};

}  // namespace

ThesisClass thesis_class_of(Verdict verdict)
{
    switch (verdict) {
    case Verdict::Valid: return ThesisClass::Valid;
    case Verdict::Aerial:
    case Verdict::OffTerrain: return ThesisClass::Aerial;
    case Verdict::Outside:
    case Verdict::Submerged:
    case Verdict::Collision:
    case Verdict::Steep:
    case Verdict::Unstable:
    case Verdict::Obstructed:
    case Verdict::Unreachable: break;
    }
    return ThesisClass::Invalid;
}

ThesisCounts write_thesis_locations(const std::filesystem::path& folder, const RasterResult& raster, bool air,
                                    const Progress& progress)
{
    std::array<std::optional<LocationFile>, thesis_class_count> files;
    for (std::size_t i = 0; i < thesis_class_count; ++i)
        if (air || ThesisClass(i) != ThesisClass::Aerial) files[i].emplace(folder / thesis_files[i]);
    constexpr std::uint64_t often = 1 << 16;  // poses
    const std::uint64_t all = air ? raster.counts.total() : raster.poses.size();
    std::uint64_t done = 0;
    for_each_pose(raster, air, [&](const RasterPose& pose) {
        if (++done % often == 0 && progress) progress(double(done) / double(all));
        auto& file = files[std::size_t(thesis_class_of(pose.verdict))];
        if (file) file->add({pose.x, pose.y, pose.z});
    });
    ThesisCounts written{};
    for (std::size_t i = 0; i < thesis_class_count; ++i)
        if (files[i]) written[i] = files[i]->finish();
    return written;
}

ThesisCounts write_thesis_locations(const std::filesystem::path& folder, const SpawnList& list)
{
    LocationFile valid(folder / thesis_files[std::size_t(ThesisClass::Valid)]),
        invalid(folder / thesis_files[std::size_t(ThesisClass::Invalid)]);
    for (const Spawn& spawn : list.spawns) valid.add(spawn.position);
    ThesisCounts written{};
    written[std::size_t(ThesisClass::Valid)] = valid.finish();
    invalid.finish();
    return written;
}

std::string thesis_stats(const std::vector<std::pair<std::string, std::string>>& settings, const VerdictCounts& counts,
                         const ThesisCounts& written)
{
    ThesisCounts classes{};
    for (const Verdict verdict : all_verdicts) classes[std::size_t(thesis_class_of(verdict))] += counts[verdict];
    std::string text;
    const auto line = [&](const std::string& name, const std::string& value) { text += name + ": " + value + "\n"; };
    for (const auto& [name, value] : settings) line(name, value);
    line("Judged", std::to_string(counts.total()));
    for (std::size_t i = 0; i < thesis_class_count; ++i) line(class_names[i], std::to_string(classes[i]));
    for (auto verdict = all_verdicts.rbegin(); verdict != all_verdicts.rend(); ++verdict)
        line(std::string("Verdict ") + to_string(*verdict), std::to_string(counts[*verdict]));
    for (std::size_t i = 0; i < thesis_class_count; ++i)
        line(std::string("Lines of ") + thesis_files[i], std::to_string(written[i]));
    return text;
}

}  // namespace spawnfield
