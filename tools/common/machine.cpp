#include "machine.h"

#include <spawnfield/types.h>

#include <cstdarg>
#include <cstdio>
#include <fstream>
#include <thread>

namespace tools {

std::string proc_value(const char* file, const std::string& key)
{
    std::ifstream stream(file);
    for (std::string line; std::getline(stream, line);) {
        const std::size_t value = line.find_first_not_of(" \t:", key.size());
        if (line.starts_with(key) && value != std::string::npos) return line.substr(value);
    }
    return {};
}

std::string formatted(const char* format, ...)
{
    char text[1024];
    va_list values;
    va_start(values, format);
    std::vsnprintf(text, sizeof text, format, values);
    va_end(values);
    return text;
}

std::string machine()
{
    const std::string model = proc_value("/proc/cpuinfo", "model name");
    const unsigned cores = std::thread::hardware_concurrency();
    return "spawnfield " + spawnfield::version() + " on " + (model.empty() ? "an unknown CPU" : model) + ", " +
           std::to_string(cores) + (cores == 1 ? " core" : " cores");
}

}  // namespace tools
