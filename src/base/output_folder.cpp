#include "base/temporary.h"

#include <spawnfield/error.h>
#include <spawnfield/leftovers.h>
#include <spawnfield/output_folder.h>

#include <algorithm>

namespace spawnfield {

namespace fs = std::filesystem;

namespace {

fs::path without_slash(const fs::path& path) { return path.has_filename() ? path : path.parent_path(); }

fs::path target_folder(const fs::path& folder)
{
    std::error_code error;
    const fs::path target = fs::is_symlink(folder, error) ? fs::canonical(folder, error) : folder;
    return error ? folder : target;
}

void refuse_foreign(const fs::path& target, const std::function<std::string(const fs::path&)>& objection)
{
    if (!fs::exists(target) || (fs::is_directory(target) && fs::is_empty(target))) return;
    const std::string reason = objection(target);
    if (!reason.empty()) throw OutputError(target.string(), reason + "; choose another name or remove it");
}

/// Gives a file a second name. A file system without hard links gets a copy. A file of another file system, which is
/// mounted below the folder, is an error: it would be deleted with the old folder.
void link_or_copy(const fs::path& from, const fs::path& to, std::error_code& error)
{
    if (fs::is_symlink(from)) return fs::copy_symlink(from, to, error);
    fs::create_hard_link(from, to, error);
    if (error && error != std::errc::cross_device_link && fs::is_regular_file(from)) fs::copy_file(from, to, error);
}

void link_all(const fs::path& from, const fs::path& to)
{
    std::error_code error;
    if (fs::is_directory(fs::symlink_status(from))) {
        fs::create_directory(to, from, error);
        for (fs::directory_iterator entry(from, error); !error && entry != fs::directory_iterator();
             entry.increment(error))
            link_all(entry->path(), to / entry->path().filename());
    } else {
        link_or_copy(from, to, error);
    }
    if (error) throw OutputError(from.string(), "cannot be kept in the new folder: " + error.message());
}

/// Returns whether a killed run left this incomplete result. One of a living run will get its name in the new folder.
bool is_left(const fs::path& path)
{
    const std::optional<TemporaryName> name = parse_temporary(path);
    if (!name || name->kind != TemporaryKind::New) return false;
    const Descriptor lock = open_in_place(path);
    return lock && try_lock(lock) == LockResult::Taken;
}

/// Returns the entries that `keeps` selects, without what killed runs left.
std::vector<fs::path> kept_names(const fs::path& folder, const std::function<bool(const fs::path&)>& keeps)
{
    std::vector<fs::path> out;
    if (!keeps || !fs::is_directory(folder)) return out;
    for (const fs::directory_entry& entry : fs::directory_iterator(folder))
        if (keeps(entry.path().filename()) && !is_left(entry.path())) out.push_back(entry.path().filename());
    return out;
}

/// Links the kept entries into the new folder before the two folders change places. So they are in the target at any
/// time, even if the process is killed.
void link_kept(const fs::path& old, const fs::path& now, const std::function<bool(const fs::path&)>& keeps)
{
    for (const fs::path& name : kept_names(old, keeps)) {
        std::error_code ignored;
        fs::remove_all(now / name, ignored);  // from an attempt before this one
        link_all(old / name, now / name);
    }
}

/// After the folders have changed places: moves entries that came in between, and puts the kept folders themselves in
/// the place of those that have links to their files.
void move_kept(const fs::path& old, const fs::path& now, const std::function<bool(const fs::path&)>& keeps)
{
    for (const fs::path& name : kept_names(old, keeps))
        if (!rename_to_new(old / name, now / name) && fs::is_directory(fs::symlink_status(old / name)))
            exchange_names(old / name, now / name);
}

/// Returns whether another run may have put its own folder there, or taken it away, at this moment.
bool is_disturbed(const std::error_code& error)
{
    return error == std::errc::directory_not_empty || error == std::errc::file_exists ||
           error == std::errc::no_such_file_or_directory;
}

}  // namespace

OutputFolder::OutputFolder(const Path& target, const std::function<std::string(const Path&)>& objection)
    : objection_(objection), target_(target_folder(without_slash(target)))
{
    for (const Leftover& left : clean_target(target_))
        if (!left.put_back_to.empty() && left.failure.empty())
            notices_.push_back(target_.string() + " was put back: a killed run had left it as " +
                               left.path.filename().string());
    try {
        refuse_foreign(target_, objection_);
        if (target_.has_parent_path()) fs::create_directories(target_.parent_path());
        Temporary made = make_temporary_folder(target_);
        folder_ = std::move(made.path);
        lock_ = std::make_unique<Descriptor>(std::move(made.lock));
    } catch (const std::system_error& error) {
        throw OutputError(target_.string(), "cannot be created: " + error.code().message());
    }
}

OutputFolder::~OutputFolder()
{
    std::error_code ignored;
    if (lock_) fs::remove_all(folder_, ignored);
}

void OutputFolder::commit(const std::function<bool(const Path& name)>& keeps)
{
    std::error_code error;
    for (int attempt = 0; attempt < 100; ++attempt) {
        refuse_foreign(target_, objection_);  // again, because the work may have taken hours
        link_kept(target_, folder_, keeps);
        error = put_in_place();
        if (!is_disturbed(error)) break;
    }
    if (error) throw OutputError(target_.string(), "cannot be written: " + error.message());
    lock_.reset();
    clear_old(keeps);
}

/// Gives the new folder its name. The former one, if there is any, gets a temporary name.
std::error_code OutputFolder::put_in_place()
{
    std::error_code error, ignored;
    if (!fs::exists(target_)) {
        fs::rename(folder_, target_, error);
        return error;
    }
    old_lock_ = std::make_unique<Descriptor>(open_in_place(target_));
    if (*old_lock_) try_lock(*old_lock_, true);
    const Path old = temporary_path(target_, TemporaryKind::Old);
    if (exchange_names(folder_, target_)) {  // so that the target exists at any time
        old_.push_back(rename_to_new(folder_, old) ? old : folder_);
        return {};
    }
    if (!rename_to_new(target_, old)) return {errno, std::generic_category()};
    fs::rename(folder_, target_, error);
    if (error && !rename_to_new(old, target_)) old_.push_back(old);  // another run has put its own there
    if (!error) old_.push_back(old);
    return error;
}

/// The result is in its place already, so nothing here is an error.
void OutputFolder::clear_old(const std::function<bool(const Path& name)>& keeps)
{
    for (const Path& old : old_) {
        std::error_code error;
        try {
            move_kept(old, target_, keeps);
        } catch (const fs::filesystem_error& failed) {
            error = failed.code();
        }
        if (!error) fs::remove_all(old, error);
        if (error)
            notices_.push_back(old.string() + ", the former " + target_.filename().string() +
                               ", could not be removed: " + error.message() + "; remove it by hand");
    }
    old_.clear();
    old_lock_.reset();
}

std::function<std::string(const fs::path&)> holds_only(std::span<const char* const> names, const std::string& kind)
{
    return [names, kind](const fs::path& folder) -> std::string {
        if (!fs::is_directory(folder)) return "exists and is not a folder";
        std::string foreign;  // the first by name, as the order of entries in a folder is not defined
        for (const fs::directory_entry& entry : fs::directory_iterator(folder)) {
            const std::string name = entry.path().filename().string();
            const bool known = entry.is_regular_file() && std::find(names.begin(), names.end(), name) != names.end();
            if (!known && (foreign.empty() || name < foreign)) foreign = name;
        }
        return foreign.empty() ? "" : "contains " + foreign + ", which is not part of any " + kind;
    };
}

}  // namespace spawnfield
