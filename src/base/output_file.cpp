#include <spawnfield/error.h>
#include <spawnfield/output_file.h>

#include <unistd.h>

#include <cerrno>
#include <cstring>

namespace spawnfield {

namespace fs = std::filesystem;

namespace {

/// Returns whether the file is a pipe, a device, or a system link to the standard output (/dev/stdout,
/// /proc/self/fd/1), even if that is redirected to a regular file. Such files are written directly.
bool is_special(const fs::path& file)
{
    std::error_code ignored;
    if (!fs::exists(file, ignored)) return false;
    const std::string name = fs::absolute(file, ignored).lexically_normal().string();
    const bool is_of_system = name.starts_with("/dev/") || name.starts_with("/proc/");
    return !fs::is_regular_file(file, ignored) || (is_of_system && fs::is_symlink(file, ignored));
}

/// Follows links, so that the target is replaced and the links stay.
fs::path target_of(const fs::path& file)
{
    std::error_code error;
    const fs::path target = fs::canonical(file, error);
    return error ? file : target;
}

}  // namespace

OutputFile::OutputFile(fs::path file) : file_(std::move(file))
{
    std::error_code ignored;
    if (fs::is_directory(file_, ignored)) fail("is a folder");
    if (is_special(file_)) {
        written_ = file_;
    } else {
        target_ = target_of(file_);
        written_ = target_.string() + ".tmp-" + std::to_string(getpid());
    }
    // A file behind /dev/stdout may have content already; it is kept.
    stream_.open(written_, std::ios::binary | (target_.empty() ? std::ios::app : std::ios::trunc));
    if (!stream_) fail(std::strerror(errno));
}

OutputFile::~OutputFile()
{
    std::error_code ignored;
    if (stream_.is_open() && !target_.empty()) fs::remove(written_, ignored);
}

void OutputFile::write(std::string_view bytes)
{
    stream_.write(bytes.data(), std::streamsize(bytes.size()));
    if (!stream_) fail(std::strerror(errno));
}

void OutputFile::flush()
{
    stream_.flush();
    if (!stream_) fail(std::strerror(errno));
}

void OutputFile::commit()
{
    flush();
    if (!target_.empty()) {
        std::error_code error;
        fs::rename(written_, target_, error);
        if (error) fail(error.message());
    }
    stream_.close();
}

void OutputFile::keep_old()
{
    std::error_code error;
    if (target_.empty() || !fs::exists(target_, error)) return;
    const fs::path old = target_.string() + ".old-" + std::to_string(getpid());
    fs::remove(old, error);
    fs::create_hard_link(target_, old, error);      // a link, so that a file of this name exists at any time
    if (error) fs::copy_file(target_, old, error);  // for file systems without hard links
    if (error) fail(error.message());
    old_ = old;
}

void OutputFile::put_old_back() noexcept
{
    std::error_code ignored;
    if (old_.empty() && !target_.empty())
        fs::remove(target_, ignored);
    else if (!old_.empty())
        fs::rename(old_, target_, ignored);
    old_.clear();
}

void OutputFile::forget_old() noexcept
{
    std::error_code ignored;
    if (!old_.empty()) fs::remove(old_, ignored);
    old_.clear();
}

void OutputFile::commit_together(std::span<OutputFile* const> files)
{
    for (OutputFile* const file : files) file->flush();
    std::size_t done = 0;
    try {
        for (OutputFile* const file : files) file->keep_old();
        for (; done < files.size(); ++done) files[done]->commit();
    } catch (...) {
        for (std::size_t f = 0; f < files.size(); ++f) f < done ? files[f]->put_old_back() : files[f]->forget_old();
        throw;
    }
    for (OutputFile* const file : files) file->forget_old();
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
