#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <utility>

namespace spawnfield {

/// An open file or folder, closed at the end. Descriptor -1: none.
class Descriptor {
public:
    explicit Descriptor(int descriptor = -1) : descriptor_(descriptor) {}
    Descriptor(Descriptor&& other) noexcept : descriptor_(std::exchange(other.descriptor_, -1)) {}
    Descriptor& operator=(Descriptor&& other) noexcept
    {
        std::swap(descriptor_, other.descriptor_);
        return *this;
    }
    ~Descriptor();

    explicit operator bool() const { return descriptor_ >= 0; }
    int get() const { return descriptor_; }

private:
    int descriptor_;
};

/// What a temporary name is for.
enum class TemporaryKind {
    New,  ///< TARGET.tmp-…: a result that is not complete yet
    Old,  ///< TARGET.old-…: what the result replaces
};

/// Returns a new name beside the target, with 12 characters at the end. The last four are a checksum of the rest, so
/// that no name that a user chooses is taken for a temporary one, for example map.old-backup.
std::filesystem::path temporary_path(const std::filesystem::path& target, TemporaryKind kind);

struct TemporaryName {
    std::filesystem::path target;
    TemporaryKind kind;
};

/// Returns what temporary_path() made this path from; nothing if another name was given.
std::optional<TemporaryName> parse_temporary(const std::filesystem::path& path);

/// A new file or folder with a temporary name of the kind New. It is locked while `lock` is open, so that other runs
/// can see that its run is alive, also in other process namespaces.
struct Temporary {
    std::filesystem::path path;
    Descriptor lock;  ///< of a file: open for reading and writing
};

/// Make a file or a folder that did not exist, with the permissions that the umask leaves. Throw std::system_error.
Temporary make_temporary_file(const std::filesystem::path& target);
Temporary make_temporary_folder(const std::filesystem::path& target);

/// Opens what has this name, but does not follow a link. Returns none if that fails.
Descriptor open_in_place(const std::filesystem::path& path);

enum class LockResult { Taken, Busy, Unsupported };

/// Locks an open file or folder until it is closed. Does not wait. `is_shared`: others may share the lock.
LockResult try_lock(const Descriptor& descriptor, bool is_shared = false);

/// Returns whether the path is the name of this open file or folder, and not a link to it.
bool is_named(const Descriptor& descriptor, const std::filesystem::path& path);

/// Returns the same, but follows a link.
bool is_reached_by(const Descriptor& descriptor, const std::filesystem::path& path);

/// Exchange two names, or rename unless the new name exists, atomically. Return false if this fails, for example
/// because the file system cannot do it; then errno says why.
bool exchange_names(const std::filesystem::path& a, const std::filesystem::path& b);
bool rename_to_new(const std::filesystem::path& from, const std::filesystem::path& to);

}  // namespace spawnfield
