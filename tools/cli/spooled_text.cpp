#include "spooled_text.h"

#include <spawnfield/error.h>

#include <fcntl.h>
#include <unistd.h>

#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <utility>

namespace spawnfield::cli {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t most_in_memory = 16 << 20;  // bytes

std::string folder()
{
    const char* const chosen = std::getenv("TMPDIR");
    return chosen != nullptr && *chosen != 0 ? chosen : "/tmp";
}

[[noreturn]] void fail(const std::string& what)
{
    throw OutputError("standard output", "a temporary file in " + folder() + " " + what + ": " + std::strerror(errno) +
                                             "; set TMPDIR to another folder, or write to a file with -o");
}

/// Returns a descriptor of a file without a name.
int unnamed_file()
{
    const int file = open(folder().c_str(), O_TMPFILE | O_RDWR | O_CLOEXEC, 0600);
    if (file >= 0) return file;
    std::string name = folder() + "/spawnfield.XXXXXX";  // some file systems cannot make files without a name
    const int named = mkostemp(name.data(), O_CLOEXEC);
    if (named < 0) fail("cannot be made");
    unlink(name.c_str());
    return named;
}

}  // namespace

SpooledText::~SpooledText()
{
    if (file_ >= 0) close(file_);
}

void SpooledText::add(std::string_view text)
{
    waiting_ += text;
    if (waiting_.size() >= most_in_memory) write_to_file();
}

void SpooledText::write_to_file()
{
    if (file_ < 0) file_ = unnamed_file();
    std::string_view left = waiting_;
    while (!left.empty()) {
        const ssize_t count = ::write(file_, left.data(), left.size());
        if (count < 0 && errno != EINTR) fail("cannot be written");
        if (count > 0) left.remove_prefix(std::size_t(count));
    }
    waiting_.clear();
}

void SpooledText::pass_to(const std::function<void(std::string_view)>& sink)
{
    if (file_ >= 0) {
        const std::string last = std::exchange(waiting_, std::string(1 << 20, '\0'));
        if (lseek(file_, 0, SEEK_SET) != 0) fail("cannot be read");
        for (ssize_t count = 1; count != 0;) {
            count = ::read(file_, waiting_.data(), waiting_.size());
            if (count < 0 && errno != EINTR) fail("cannot be read");
            if (count > 0) sink(std::string_view(waiting_).substr(0, std::size_t(count)));
        }
        waiting_ = last;
    }
    sink(waiting_);
}

}  // namespace spawnfield::cli
