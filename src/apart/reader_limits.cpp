#include "apart/reader_limits.h"

#include <spawnfield/error.h>

#include <sys/resource.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <fstream>

namespace spawnfield {
namespace {

constexpr double megabyte = 1e6;
constexpr double memory_per_megabyte = 900 * megabyte;  // bytes; a flat elevation model is packed to 1 : 700
constexpr double least_seconds = is_sanitized ? 200 : 12, seconds_per_megabyte = is_sanitized ? 100 : 5;
constexpr rlim_t most_stack = 8 << 20;  // bytes

/// Returns the private writable memory of this process, which RLIMIT_DATA limits, in bytes. Source: proc(5), statm.
std::uint64_t data_memory()
{
    std::ifstream statm("/proc/self/statm");
    std::uint64_t pages = 0;
    for (int field = 0; field < 6; ++field) statm >> pages;
    return pages * std::uint64_t(sysconf(_SC_PAGESIZE));
}

/// Lowers the soft limit to the value, as far as the hard limit allows.
void limit(__rlimit_resource resource, double value)
{
    rlimit both{};
    getrlimit(resource, &both);
    both.rlim_cur = value >= double(both.rlim_max) ? both.rlim_max : rlim_t(value);
    setrlimit(resource, &both);
}

template <std::size_t size>
void copy(const std::string& text, char (&to)[size])
{
    const std::size_t count = std::min(text.size(), size - 1);
    std::memcpy(to, text.data(), count);
    to[count] = 0;
}

std::filesystem::path without_links(const std::filesystem::path& path)
{
    std::error_code unreachable;
    const std::filesystem::path found = std::filesystem::canonical(path, unreachable);
    return unreachable ? path : found;
}

bool is_inside(const std::filesystem::path& path, const std::filesystem::path& folder)
{
    return std::mismatch(folder.begin(), folder.end(), path.begin(), path.end()).first == folder.end();
}

}  // namespace

ReaderLimits::ReaderLimits(ReaderStatus& status) : status_(status), at_start_(data_memory())
{
    limit(RLIMIT_CORE, 0);
    limit(RLIMIT_STACK, most_stack);
    set();
}

void ReaderLimits::confine(const std::vector<std::filesystem::path>& folders)
{
    confined_.emplace();
    for (const std::filesystem::path& folder : folders) confined_->push_back(without_links(folder));
}

void ReaderLimits::opens(const std::filesystem::path& file, std::uint64_t bytes)
{
    const std::filesystem::path path = without_links(file);
    if (confined_ && std::none_of(confined_->begin(), confined_->end(),
                                  [&](const std::filesystem::path& folder) { return is_inside(path, folder); }))
        throw FileError(file.string(), "is " + (path == file ? "" : path.string() + ", ") +
                                           "outside of the folders of --confine; move it there, or add its folder");
    if (!files_.insert(path).second) return;
    bytes_ += bytes;
    set();
}

void ReaderLimits::begins(const char* reader, const std::filesystem::path& file)
{
    copy(reader, status_.reader);
    copy(file.string(), status_.file);
}

void ReaderLimits::ends() { copy("", status_.reader); }

void ReaderLimits::set()
{
    const double megabytes = double(bytes_) / megabyte, memory = memory_per_megabyte * std::max(1.0, megabytes);
    status_.seconds = std::ceil(least_seconds + seconds_per_megabyte * megabytes);
    status_.gigabytes = memory / 1e9;
    limit(RLIMIT_CPU, status_.seconds);
    if (!is_sanitized) limit(RLIMIT_DATA, double(at_start_) + memory);
}

}  // namespace spawnfield
