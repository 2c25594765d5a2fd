#pragma once

#include <sys/resource.h>
#include <unistd.h>

#include <fstream>

namespace spawnfield {

/// Returns the private writable memory of this process, which RLIMIT_DATA limits, in bytes. Source: proc(5), statm.
inline double data_memory()
{
    std::ifstream statm("/proc/self/statm");
    double pages = 0;
    for (int field = 0; field < 6; ++field) statm >> pages;
    return pages * double(sysconf(_SC_PAGESIZE));
}

/// Sets the soft limit of a resource to the value, as far as the hard limit allows.
inline void limit_resource(__rlimit_resource resource, double value)
{
    rlimit both{};
    getrlimit(resource, &both);
    both.rlim_cur = value >= double(both.rlim_max) ? both.rlim_max : rlim_t(value);
    setrlimit(resource, &both);
}

}  // namespace spawnfield
