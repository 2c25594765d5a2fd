#include "base/temporary.h"

#include <spawnfield/error.h>
#include <spawnfield/leftovers.h>

#include <sys/stat.h>

#include <algorithm>
#include <cerrno>
#include <optional>
#include <set>
#include <utility>

namespace spawnfield {

namespace fs = std::filesystem;

namespace {

/// A file or folder with a temporary name, which may belong to a living run.
struct Candidate {
    fs::path path;
    TemporaryName name;
    timespec changed;  ///< when it got its name
};

bool is_later(const timespec& a, const timespec& b)
{
    return a.tv_sec != b.tv_sec ? a.tv_sec > b.tv_sec : a.tv_nsec > b.tv_nsec;
}

bool has_entry(const fs::path& path)
{
    struct stat ignored {};
    return lstat(path.c_str(), &ignored) == 0;
}

void add_if_temporary(std::vector<Candidate>& candidates, const fs::path& path)
{
    const std::optional<TemporaryName> name = parse_temporary(path);
    struct stat about {};
    if (!name || lstat(path.c_str(), &about) != 0) return;
    if (S_ISREG(about.st_mode) || S_ISDIR(about.st_mode)) candidates.push_back({path, *name, about.st_ctim});
}

/// Removes the file or folder, or puts it back, unless a living run holds it: then returns nothing. `taken`: targets
/// that got something back already.
std::optional<Leftover> clean_one(const Candidate& candidate, std::set<fs::path>& taken, bool dry_run)
{
    const auto& [path, name, changed] = candidate;
    const Descriptor lock = open_in_place(path);
    // Its run may have given it its final name after it was listed, so that now the lock is free.
    if (!lock || try_lock(lock) != LockResult::Taken || !is_named(lock, path)) return std::nullopt;
    const bool is_needed = name.kind == TemporaryKind::Old && !has_entry(name.target) &&
                           taken.insert(name.target).second;
    Leftover out{path, is_needed ? name.target : fs::path(), ""};
    if (dry_run) return out;
    std::error_code error;
    if (!is_needed)
        fs::remove_all(path, error);
    else if (!rename_to_new(path, name.target))
        error.assign(errno, std::generic_category());
    if (error) out.failure = error.message();
    return out;
}

std::vector<Leftover> clean(std::vector<Candidate> candidates, bool dry_run)
{
    // The latest old one of a target is the one that is put back.
    std::sort(candidates.begin(), candidates.end(),
              [](const Candidate& a, const Candidate& b) { return is_later(a.changed, b.changed); });
    std::vector<Leftover> out;
    std::set<fs::path> taken;
    for (const Candidate& candidate : candidates)
        if (std::optional<Leftover> left = clean_one(candidate, taken, dry_run)) out.push_back(*std::move(left));
    std::sort(out.begin(), out.end(), [](const Leftover& a, const Leftover& b) { return a.path < b.path; });
    return out;
}

/// Adds those of a folder. `is_below`: a folder that may not be read is left out.
void add_from(std::vector<Candidate>& candidates, const fs::path& folder, bool recursive, bool is_below)
{
    std::error_code error, ignored;
    const auto options = is_below ? fs::directory_options::skip_permission_denied : fs::directory_options::none;
    for (fs::directory_iterator entry(folder, options, error); !error && entry != fs::directory_iterator();
         entry.increment(error)) {
        if (parse_temporary(entry->path()))
            add_if_temporary(candidates, entry->path());
        else if (recursive && entry->is_directory(ignored) && !entry->is_symlink(ignored))
            add_from(candidates, entry->path(), true, true);
    }
    if (error) throw FileError(folder.string(), "cannot be read: " + error.message());
}

}  // namespace

std::vector<Leftover> clean_folder(const fs::path& folder, const CleanOptions& options)
{
    std::vector<Candidate> candidates;
    add_from(candidates, folder, options.recursive, false);
    return clean(std::move(candidates), options.dry_run);
}

std::vector<Leftover> clean_target(const fs::path& target)
{
    std::vector<Candidate> candidates;
    std::error_code error;
    const fs::path folder = target.has_parent_path() ? target.parent_path() : fs::path(".");
    for (fs::directory_iterator entry(folder, error); !error && entry != fs::directory_iterator();
         entry.increment(error)) {
        const std::optional<TemporaryName> name = parse_temporary(entry->path());
        if (name && name->target.filename() == target.filename()) add_if_temporary(candidates, entry->path());
    }
    return clean(std::move(candidates), false);
}

}  // namespace spawnfield
