#include "this_build.h"

bool is_slow_build() { return SLOW_BUILD != 0; }

const std::string& source_folder()
{
    static const std::string folder = SPAWNFIELD_SOURCE;
    return folder;
}

const std::string& program_file()
{
    static const std::string file = SPAWNFIELD_CLI;
    return file;
}

const std::string& python_file()
{
    static const std::string file = TEST_PYTHON;
    return file;
}
