#define CATCH_CONFIG_RUNNER
#include "catch.h"

#include <tbb/global_control.h>

#ifdef __SANITIZE_ADDRESS__
// assimp leaks where it gives up on a damaged file.
extern "C" const char* __lsan_default_suppressions() { return "leak:libassimp"; }
#endif

int main(int argc, char** argv)
{
    // Tests ask for up to 8 threads, on a machine with fewer cores too.
    const tbb::global_control allowed(tbb::global_control::max_allowed_parallelism, 8);
    return Catch::Session().run(argc, argv);
}
