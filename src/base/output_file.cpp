#include "base/temporary.h"

#include <spawnfield/error.h>
#include <spawnfield/leftovers.h>
#include <spawnfield/output_file.h>

#include <fcntl.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <system_error>

namespace spawnfield {

namespace fs = std::filesystem;

namespace {

/// Follows links, so that the target is replaced and the links stay.
fs::path target_of(const fs::path& file)
{
    std::error_code error;
    const fs::path target = fs::canonical(file, error);
    return error ? file : target;
}

/// Gives a file a second name of the kind Old. Where the file system has no hard links, this is a copy, which gets its
/// name when it is complete. Throws std::system_error.
Temporary second_name_of(const fs::path& file)
{
    Descriptor lock = open_in_place(file);
    if (lock) try_lock(lock, true);  // first, so that other runs never see the second name without a lock
    const fs::path second = temporary_path(file, TemporaryKind::Old);
    std::error_code error;
    fs::create_hard_link(file, second, error);
    if (!error) return {second, std::move(lock)};
    Temporary copy = make_temporary_file(file);
    fs::copy_file(file, copy.path, fs::copy_options::overwrite_existing, error);
    if (!error && !rename_to_new(copy.path, second)) error.assign(errno, std::generic_category());
    if (!error) return {second, std::move(copy.lock)};
    std::error_code ignored;
    fs::remove(copy.path, ignored);
    throw std::system_error(error);
}

}  // namespace

bool is_written_directly(const fs::path& file)
{
    std::error_code ignored;
    if (!fs::exists(file, ignored)) return false;
    const std::string name = fs::absolute(file, ignored).lexically_normal().string();
    const bool is_of_system = name.starts_with("/dev/") || name.starts_with("/proc/");
    return (!fs::is_regular_file(file, ignored) && !fs::is_directory(file, ignored)) ||
           (is_of_system && fs::is_symlink(file, ignored));
}

OutputFile::OutputFile(fs::path file) : file_(std::move(file))
{
    std::error_code ignored;
    if (fs::is_directory(file_, ignored)) fail("is a folder");
    if (is_written_directly(file_))
        open_directly();
    else
        open_beside();
}

void OutputFile::open_beside()
{
    target_ = target_of(file_);
    clean_target(target_);
    try {
        Temporary made = make_temporary_file(target_);
        written_ = std::move(made.path);
        descriptor_ = std::make_unique<Descriptor>(std::move(made.lock));
    } catch (const std::system_error& error) {
        fail(error.code().message());
    }
}

/// A file behind /dev/stdout may have content already; it is kept.
void OutputFile::open_directly()
{
    written_ = file_;
    descriptor_ = std::make_unique<Descriptor>(open(written_.c_str(), O_WRONLY | O_CREAT | O_APPEND | O_CLOEXEC, 0666));
    if (!*descriptor_) fail(std::strerror(errno));
}

OutputFile::~OutputFile()
{
    std::error_code ignored;
    if (descriptor_ && !target_.empty()) fs::remove(written_, ignored);
}

void OutputFile::write(std::string_view bytes)
{
    constexpr std::size_t piece = 1 << 16;
    if (waiting_.size() + bytes.size() < piece) {
        waiting_ += bytes;
        return;
    }
    flush();
    write_through(bytes);
}

void OutputFile::write_through(std::string_view bytes)
{
    while (!bytes.empty()) {
        const ssize_t count = ::write(descriptor_->get(), bytes.data(), bytes.size());
        if (count < 0 && errno != EINTR) fail(std::strerror(errno));
        if (count > 0) bytes.remove_prefix(std::size_t(count));
    }
}

void OutputFile::flush()
{
    const std::string bytes = std::exchange(waiting_, {});
    write_through(bytes);
}

void OutputFile::commit()
{
    flush();
    if (!target_.empty()) {
        std::error_code error;
        fs::rename(written_, target_, error);
        if (error) fail(error.message());
    }
    descriptor_.reset();
}

void OutputFile::keep_old()
{
    std::error_code ignored;
    if (target_.empty() || !fs::exists(target_, ignored)) return;
    try {
        Temporary old = second_name_of(target_);
        old_ = std::move(old.path);
        old_lock_ = std::make_unique<Descriptor>(std::move(old.lock));
    } catch (const std::system_error& error) {
        fail(error.code().message());
    }
}

void OutputFile::put_old_back() noexcept
{
    std::error_code ignored;
    if (old_.empty() && !target_.empty())
        fs::remove(target_, ignored);
    else if (!old_.empty())
        fs::rename(old_, target_, ignored);
    old_.clear();
    old_lock_.reset();
}

std::string OutputFile::forget_old()
{
    std::error_code error;
    if (!old_.empty()) fs::remove(old_, error);
    const std::string notice = error ? old_.string() + ", the former " + target_.filename().string() +
                                           ", could not be removed: " + error.message() + "; remove it by hand"
                                     : "";
    old_.clear();
    old_lock_.reset();
    return notice;
}

std::vector<std::string> OutputFile::commit_together(std::span<OutputFile* const> files)
{
    for (OutputFile* const file : files) file->flush();
    std::size_t done = 0;
    try {
        for (OutputFile* const file : files) file->keep_old();
        for (; done < files.size(); ++done) files[done]->commit();
    } catch (...) {
        for (std::size_t f = 0; f < files.size(); ++f)
            if (f < done)
                files[f]->put_old_back();
            else
                files[f]->forget_old();
        throw;
    }
    std::vector<std::string> notices;
    for (OutputFile* const file : files)
        if (std::string notice = file->forget_old(); !notice.empty()) notices.push_back(std::move(notice));
    return notices;
}

void OutputFile::fail(const std::string& reason) const
{
    throw OutputError(file_.string(), "cannot be written: " + reason);
}

void write_file_atomically(const fs::path& file, std::string_view bytes)
{
    OutputFile out(file);
    out.write(bytes);
    out.commit();
}

}  // namespace spawnfield
