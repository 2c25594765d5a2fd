#include "apart/reader_limits.h"

#include "base/process_limits.h"

#include <spawnfield/error.h>
#include <spawnfield/input_file.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <ctime>
#include <limits>

namespace spawnfield {
namespace {

constexpr double megabyte = 1e6;
constexpr double memory_per_megabyte = 900 * megabyte;  // bytes; a flat elevation model is packed to 1 : 700
constexpr double least_seconds = is_sanitized ? 200 : 12, seconds_per_megabyte = is_sanitized ? 100 : 5;
constexpr double unlimited = std::numeric_limits<double>::infinity();
constexpr rlim_t most_stack = 8 << 20;  // bytes

double processor_time()  // of all threads of this process, s
{
    timespec time{};
    clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &time);
    return double(time.tv_sec) + 1e-9 * double(time.tv_nsec);
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

}  // namespace

ReaderLimits::ReaderLimits(ReaderStatus& status) : status_(status), at_start_(data_memory())
{
    limit_resource(RLIMIT_CORE, 0);
    limit_resource(RLIMIT_STACK, most_stack);
    limit_memory();
}

void ReaderLimits::confine(const std::vector<std::filesystem::path>& folders)
{
    for (const std::filesystem::path& folder : folders) confined_.push_back(without_links(folder));
}

void ReaderLimits::limit_memory_to(double bytes)
{
    most_memory_ = bytes;
    limit_memory();
}

void ReaderLimits::opens(const std::filesystem::path& file, std::uint64_t bytes)
{
    const std::filesystem::path path = without_links(file);
    if (!confined_.empty() &&
        std::none_of(confined_.begin(), confined_.end(),
                     [&](const std::filesystem::path& folder) { return is_in_folder(path, folder); }))
        throw FileError(file.string(),
                        "is " + (path == file ? "" : path.string() + ", ") +
                            "outside of the folders from which files may be read; move it there, or allow "
                            "its folder, too (--confine)");
    if (is_reading_ && its_files_.insert(path).second) {
        its_bytes_ += bytes;
        limit_time();
    }
    if (files_.insert(path).second) {
        bytes_ += bytes;
        limit_memory();
    }
}

void ReaderLimits::begins(const char* reader, const std::filesystem::path& file)
{
    copy(reader, status_.reader);
    copy(file.string(), status_.file);
    is_reading_ = true;
    its_files_.clear();
    its_bytes_ = 0;
    began_at_ = processor_time();
    limit_time();
}

void ReaderLimits::ends(bool has_failed)
{
    is_reading_ = false;
    limit_resource(RLIMIT_CPU, unlimited);
    if (!has_failed) copy("", status_.reader);  // after an error the parent needs the name
}

void ReaderLimits::limit_memory()
{
    const double for_files = memory_per_megabyte * std::max(1.0, double(bytes_) / megabyte),
                 memory = std::min(for_files, most_memory_);
    status_.gigabytes = memory / 1e9;
    status_.is_given = memory < for_files;
    if (!is_sanitized) limit_resource(RLIMIT_DATA, at_start_ + memory);
}

void ReaderLimits::limit_time()
{
    status_.seconds = std::ceil(least_seconds + seconds_per_megabyte * double(its_bytes_) / megabyte);
    limit_resource(RLIMIT_CPU, std::ceil(began_at_) + status_.seconds);
}

}  // namespace spawnfield
