#include "base/number.h"
#include "base/process_limits.h"
#include "base/sanitized.h"

#include <spawnfield/memory.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <limits>
#include <string>

namespace spawnfield {
namespace {

namespace fs = std::filesystem;

constexpr double unknown = std::numeric_limits<double>::infinity();

/// Returns the number at the beginning of a file; `unknown` if there is none, as in "max".
double number_in(const fs::path& file)
{
    double value = 0;
    return std::ifstream(file) >> value ? value : unknown;
}

/// Returns the memory that the system has available, in bytes.
double available_in_system()
{
    std::ifstream file("/proc/meminfo");
    for (std::string name, unit; file >> name;) {
        double kibibytes = 0;
        file >> kibibytes;
        if (name == "MemAvailable:") return kibibytes * 1024;
        std::getline(file, unit);
    }
    return unknown;
}

/// Returns the memory of a group's file pages, which it can drop, in bytes.
double file_pages(const fs::path& stat, const std::string& prefix)
{
    double out = 0, value = 0;
    std::ifstream file(stat);
    for (std::string name; file >> name >> value;)
        if (name == prefix + "inactive_file" || name == prefix + "active_file") out += value;
    return out;
}

/// The files of a control group that has a limit of memory.
struct GroupFiles {
    const char* root;
    const char* limit;
    const char* used;
    const char* stat_prefix;  ///< of the names in memory.stat that count the groups below, too
};

/// Returns what the group in this folder, and those above it, leave free, in bytes.
double available_in_groups(const GroupFiles& files, const std::string& group)
{
    double out = unknown;
    for (fs::path at = group;; at = at.parent_path()) {
        const fs::path folder = files.root + (at == at.root_path() ? "" : at.string());
        const double limit = number_in(folder / files.limit);
        const double used = number_in(folder / files.used) - file_pages(folder / "memory.stat", files.stat_prefix);
        if (limit < unknown) out = std::min(out, std::max(0.0, limit - used));
        if (!at.has_relative_path()) return out;
    }
}

/// Returns what all control groups of this process leave free. A container often sees its own group as the root.
double available_in_all_groups()
{
    double out = unknown;
    std::ifstream file("/proc/self/cgroup");
    for (std::string line; std::getline(file, line);) {  // "0::/GROUP" (v2) or "4:memory:/GROUP" (v1)
        const std::size_t first = line.find(':'), second = line.find(':', first + 1);
        if (second == std::string::npos) continue;
        const std::string controllers = line.substr(first + 1, second - first - 1), group = line.substr(second + 1);
        if (controllers.empty())
            out = std::min(out, available_in_groups({"/sys/fs/cgroup", "memory.max", "memory.current", ""}, group));
        else if ((',' + controllers + ',').find(",memory,") != std::string::npos)
            out = std::min(
                out, available_in_groups(
                         {"/sys/fs/cgroup/memory", "memory.limit_in_bytes", "memory.usage_in_bytes", "total_"}, group));
    }
    return out;
}

}  // namespace

double available_memory() { return std::min(available_in_system(), available_in_all_groups()); }

void limit_memory(double bytes)
{
    if (!is_sanitized) limit_resource(RLIMIT_DATA, data_memory() + bytes);
}

std::string memory_text(double bytes)
{
    char text[32];
    if (bytes < 999.5e6)
        std::snprintf(text, sizeof text, "%.0f MB", bytes / 1e6);
    else
        std::snprintf(text, sizeof text, "%.3g GB", bytes / 1e9);
    return text;
}

void require_cell_memory(const MemoryNeed& need, const std::string& name, double cell, double area, double limit)
{
    const double needed = need.fixed + need.per_item * area / (cell * cell);
    if (!(needed > limit)) return;
    std::string message = "needs about " + memory_text(needed) + " of memory at " + rounded(cell) + " m (" + name +
                          "), the limit is " + memory_text(limit) + " (--max-memory)";
    if (need.fixed < 0.9 * limit) {
        const double fits = std::sqrt(area * need.per_item / (limit - need.fixed));
        const double digit = std::pow(10, std::floor(std::log10(fits)) - 1);  // two digits, rounded up
        message += "; " + rounded(std::ceil(fits / digit) * digit) + " m would fit";
    } else {
        message += ", and " + memory_text(need.fixed) + " are for the scene alone; a coarser one does not help";
    }
    throw MemoryError(message);
}

}  // namespace spawnfield
