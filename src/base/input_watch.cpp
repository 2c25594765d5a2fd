#include "base/input_watch.h"

#include <exception>

namespace spawnfield {
namespace {

InputWatch* watch_of_process = nullptr;

}  // namespace

void set_input_watch(InputWatch& watch) { watch_of_process = &watch; }

void count_input(const std::filesystem::path& file)
{
    if (watch_of_process == nullptr) return;
    std::error_code unknown;
    const std::uintmax_t bytes = std::filesystem::file_size(file, unknown);
    if (!unknown) watch_of_process->opens(file, bytes);
}

ForeignReading::ForeignReading(const char* reader, const std::filesystem::path& file)
{
    if (watch_of_process != nullptr) watch_of_process->begins(reader, file);
}

ForeignReading::~ForeignReading()
{
    if (watch_of_process != nullptr) watch_of_process->ends(std::uncaught_exceptions() > 0);
}

}  // namespace spawnfield
