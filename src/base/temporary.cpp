#include "base/temporary.h"

#include "base/checksum.h"

#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstdio>
#include <random>
#include <system_error>

namespace spawnfield {

namespace fs = std::filesystem;

namespace {

constexpr std::string_view letters = "abcdefghijklmnopqrstuvwxyz0123456789";
constexpr std::size_t random_length = 8, check_length = 4;
constexpr int most_attempts = 100;  // another run disturbs an attempt only if it looks for leftovers at that moment

std::string_view mark_of(TemporaryKind kind) { return kind == TemporaryKind::New ? ".tmp-" : ".old-"; }

std::string random_letters()
{
    std::random_device random;  // not a seeded engine: two runs with one seed must not choose the same names
    std::uniform_int_distribution<std::size_t> index(0, letters.size() - 1);
    std::string out(random_length, ' ');
    for (char& letter : out) letter = letters[index(random)];
    return out;
}

std::string check_of(std::string_view name) { return checksum(name).substr(0, check_length); }

Descriptor create_file(const fs::path& path)
{
    return Descriptor(open(path.c_str(), O_RDWR | O_CREAT | O_EXCL | O_NOFOLLOW | O_CLOEXEC, 0666));
}

Descriptor create_folder(const fs::path& path)
{
    if (mkdir(path.c_str(), 0777) != 0) return Descriptor();
    Descriptor out(open(path.c_str(), O_RDONLY | O_DIRECTORY | O_NOFOLLOW | O_CLOEXEC));
    if (!out && errno == ENOENT) errno = EEXIST;  // another run has removed it already
    return out;
}

bool is_same(const Descriptor& descriptor, const struct stat& other)
{
    struct stat one {};
    return fstat(descriptor.get(), &one) == 0 && one.st_dev == other.st_dev && one.st_ino == other.st_ino;
}

/// Creates, locks, and then looks whether the name is still there: another run that looked for leftovers may have taken
/// the lock first.
Temporary make_temporary(const fs::path& target, Descriptor (*create)(const fs::path&))
{
    for (int attempt = 0; attempt < most_attempts; ++attempt) {
        const fs::path path = temporary_path(target, TemporaryKind::New);
        Descriptor made = create(path);
        const int reason = errno;
        if (made && try_lock(made) != LockResult::Busy && is_named(made, path)) return {path, std::move(made)};
        if (!made && reason != EEXIST) throw std::system_error(reason, std::generic_category());
        std::error_code ignored;
        if (made) fs::remove(path, ignored);
    }
    throw std::system_error(EEXIST, std::generic_category());
}

}  // namespace

Descriptor::~Descriptor()
{
    if (descriptor_ >= 0) close(descriptor_);
}

fs::path temporary_path(const fs::path& target, TemporaryKind kind)
{
    const std::string name = target.filename().string() + std::string(mark_of(kind)) + random_letters();
    return target.parent_path() / (name + check_of(name));
}

std::optional<TemporaryName> parse_temporary(const fs::path& path)
{
    const std::string name = path.filename().string();
    for (const TemporaryKind kind : {TemporaryKind::New, TemporaryKind::Old}) {
        const std::string_view mark = mark_of(kind);
        const std::size_t tail = mark.size() + random_length + check_length;
        if (name.size() <= tail || name.compare(name.size() - tail, mark.size(), mark) != 0) continue;
        const std::string_view end = std::string_view(name).substr(name.size() - random_length - check_length);
        if (end.find_first_not_of(letters) != end.npos) continue;
        if (check_of(std::string_view(name).substr(0, name.size() - check_length)) != end.substr(random_length))
            continue;
        return TemporaryName{path.parent_path() / name.substr(0, name.size() - tail), kind};
    }
    return std::nullopt;
}

Temporary make_temporary_file(const fs::path& target) { return make_temporary(target, create_file); }

Temporary make_temporary_folder(const fs::path& target) { return make_temporary(target, create_folder); }

Descriptor open_in_place(const fs::path& path)
{
    // NFS locks only files that are open for writing. O_NONBLOCK: opening a pipe must not wait.
    for (const int mode : {O_RDWR, O_RDONLY})
        if (Descriptor out(open(path.c_str(), mode | O_NOFOLLOW | O_NONBLOCK | O_CLOEXEC)); out) return out;
    return Descriptor();
}

LockResult try_lock(const Descriptor& descriptor, bool is_shared)
{
    while (flock(descriptor.get(), (is_shared ? LOCK_SH : LOCK_EX) | LOCK_NB) != 0) {
        if (errno == EINTR) continue;
        return errno == EWOULDBLOCK ? LockResult::Busy : LockResult::Unsupported;
    }
    return LockResult::Taken;
}

bool is_named(const Descriptor& descriptor, const fs::path& path)
{
    struct stat named {};
    return lstat(path.c_str(), &named) == 0 && is_same(descriptor, named);
}

bool is_reached_by(const Descriptor& descriptor, const fs::path& path)
{
    struct stat reached {};
    return stat(path.c_str(), &reached) == 0 && is_same(descriptor, reached);
}

bool exchange_names(const fs::path& a, const fs::path& b)
{
    return renameat2(AT_FDCWD, a.c_str(), AT_FDCWD, b.c_str(), RENAME_EXCHANGE) == 0;
}

bool rename_to_new(const fs::path& from, const fs::path& to)
{
    if (renameat2(AT_FDCWD, from.c_str(), AT_FDCWD, to.c_str(), RENAME_NOREPLACE) == 0) return true;
    struct stat ignored {};
    if (errno != EINVAL || lstat(to.c_str(), &ignored) == 0) return false;
    return std::rename(from.c_str(), to.c_str()) == 0;  // for file systems without RENAME_NOREPLACE
}

}  // namespace spawnfield
