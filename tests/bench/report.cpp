#include "report.h"

#include <algorithm>
#include <fstream>
#include <stdexcept>

namespace bench {
namespace {

std::string hex(std::uint64_t hash) { return formatted("%016llx", static_cast<unsigned long long>(hash)); }

[[noreturn]] void fail_differing(const Row& row, std::uint64_t other, const std::string& when)
{
    throw std::runtime_error(row.scene + " " + row.stage + " with --threads " + std::to_string(row.threads) +
                             " gave the hash " + hex(row.hash) + ", but " + hex(other) + " " + when);
}

}  // namespace

double median(std::vector<double> values)
{
    std::sort(values.begin(), values.end());
    return (values[(values.size() - 1) / 2] + values[values.size() / 2]) / 2;
}

Row row_of(const std::string& scene, const std::string& stage, int threads, const std::vector<Measurement>& rounds)
{
    Row row{scene, stage, threads, rounds.front().items, rounds.front().hash, rounds.front().exact_checks};
    std::vector<double> seconds;
    for (const Measurement& round : rounds) {
        if (round.items == 0) throw std::runtime_error(scene + " " + stage + " processed no items");
        if (round.hash != row.hash) fail_differing(row, round.hash, "in another round");
        seconds.push_back(round.seconds);
    }
    row.least = *std::min_element(seconds.begin(), seconds.end());
    row.median = median(seconds);
    row.peak_memory = peak_memory_bytes();
    return row;
}

void check_same(const std::vector<Row>& rows)
{
    for (const Row& row : rows)
        for (const Row& other : rows)
            if (row.scene == other.scene && row.stage == other.stage && row.hash != other.hash)
                fail_differing(row, other.hash, "with --threads " + std::to_string(other.threads));
}

std::string table_head()
{
    return formatted("%-9s %-26s %7s %11s %10s %10s %10s %17s %7s %8s\n", "scene", "stage", "threads", "items", "ms",
                     "median ms", "items/s", "hash", "exact %", "peak MB");
}

std::string table_line(const Row& row)
{
    return formatted("%-9s %-26s %7d %11llu %10.2f %10.2f %10.4g %17s %7.2f %8.0f\n", row.scene.c_str(),
                     row.stage.c_str(), row.threads, static_cast<unsigned long long>(row.items), row.least * 1e3,
                     row.median * 1e3, row.per_second(), hex(row.hash).c_str(),
                     100 * double(row.exact_checks) / double(row.items), double(row.peak_memory) / 1e6);
}

std::string csv(const std::vector<Row>& rows)
{
    std::string out = "scene,stage,threads,items,ms,per_second,hash,median_ms,exact_checks\n";
    for (const Row& row : rows)
        out += formatted("%s,%s,%d,%llu,%.4f,%.6g,%s,%.4f,%llu\n", row.scene.c_str(), row.stage.c_str(), row.threads,
                         static_cast<unsigned long long>(row.items), row.least * 1e3, row.per_second(),
                         hex(row.hash).c_str(), row.median * 1e3, static_cast<unsigned long long>(row.exact_checks));
    return out;
}

void reset_peak_memory() { std::ofstream("/proc/self/clear_refs") << "5\n"; }

std::uint64_t peak_memory_bytes()
{
    const std::string value = tools::proc_value("/proc/self/status", "VmHWM");  // "123456 kB"
    return value.empty() ? 0 : std::stoull(value) * 1024;
}

}  // namespace bench
