#include <spawnfield/error.h>
#include <spawnfield/output_file.h>

#include <unistd.h>

#include <cerrno>
#include <cstring>

namespace spawnfield {

namespace fs = std::filesystem;

OutputFile::OutputFile(fs::path file) : file_(std::move(file))
{
    std::error_code ignored;
    if (fs::is_directory(file_, ignored)) fail("is a folder");
    const bool special = fs::exists(file_, ignored) && !fs::is_regular_file(file_, ignored);
    written_ = special ? file_ : fs::path(file_.string() + ".tmp-" + std::to_string(getpid()));
    stream_.open(written_, std::ios::binary);
    if (!stream_) fail(std::strerror(errno));
}

OutputFile::~OutputFile()
{
    std::error_code ignored;
    if (stream_.is_open() && written_ != file_) fs::remove(written_, ignored);
}

void OutputFile::write(std::string_view bytes)
{
    stream_.write(bytes.data(), std::streamsize(bytes.size()));
    if (!stream_) fail(std::strerror(errno));
}

void OutputFile::commit()
{
    stream_.flush();
    if (!stream_) fail(std::strerror(errno));
    if (written_ != file_) {
        std::error_code error;
        fs::rename(written_, file_, error);
        if (error) fail(error.message());
    }
    stream_.close();
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
