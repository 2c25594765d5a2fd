#include <spawnfield/error.h>
#include <spawnfield/output_folder.h>

#include <fcntl.h>
#include <unistd.h>

#include <algorithm>
#include <cstdio>

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

/// Exchanges two folders atomically, so that the target exists at any time. Returns false if the file system cannot do
/// this.
bool exchange(const fs::path& a, const fs::path& b)
{
    return renameat2(AT_FDCWD, a.c_str(), AT_FDCWD, b.c_str(), RENAME_EXCHANGE) == 0;
}

}  // namespace

OutputFolder::OutputFolder(const Path& target, const std::function<std::string(const Path&)>& objection)
    : target_(target_folder(without_slash(target)))
{
    refuse_foreign(target_, objection);
    const std::string suffix = "-" + std::to_string(getpid());
    folder_ = target_.string() + ".tmp" + suffix;
    old_ = target_.string() + ".old" + suffix;
    std::error_code error;
    fs::create_directories(folder_, error);
    if (error) throw OutputError(folder_.string(), "cannot be created: " + error.message());
}

OutputFolder::~OutputFolder()
{
    std::error_code ignored;
    fs::remove_all(folder_, ignored);
}

void OutputFolder::commit(const std::function<void(const Path& old, const Path& now)>& keep)
{
    std::error_code error, ignored;
    if (!fs::exists(target_)) {
        fs::rename(folder_, target_, error);
    } else if (exchange(folder_, target_)) {
        fs::rename(folder_, old_, error);
        if (error) exchange(folder_, target_);
    } else {
        fs::rename(target_, old_, error);
        if (!error) fs::rename(folder_, target_, error);
    }
    if (error) {
        if (fs::exists(old_)) fs::rename(old_, target_, ignored);
        throw OutputError(target_.string(), "cannot be written: " + error.message());
    }
    if (!fs::exists(old_)) return;
    if (keep) keep(old_, target_);
    fs::remove_all(old_, ignored);
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
