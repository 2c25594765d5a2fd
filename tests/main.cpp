#define CATCH_CONFIG_RUNNER
#include "catch.h"

#ifdef __SANITIZE_ADDRESS__
// assimp leaks memory when it rejects a damaged file.
extern "C" const char* __lsan_default_suppressions() { return "leak:libassimp"; }
#endif

int main(int argc, char** argv) { return Catch::Session().run(argc, argv); }
