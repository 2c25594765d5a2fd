#define CATCH_CONFIG_RUNNER
#include "catch.h"
#include "skip.h"

#include <iostream>

#include <tbb/global_control.h>

// For the address sanitizer: assimp leaks memory when it rejects a damaged file.
extern "C" const char* __lsan_default_suppressions() { return "leak:libassimp"; }

namespace {

// A test without assertions fails, and so does a choice of tests that matches none.
#if __has_include(<catch2/catch_all.hpp>)
constexpr auto strict = Catch::WarnAbout::NoAssertions | Catch::WarnAbout::UnmatchedTestSpec;
#else
constexpr auto strict = Catch::WarnAbout::NoAssertions | Catch::WarnAbout::NoTests;
#endif

int skipped = 0;

}  // namespace

void skip_test(const std::string& why)
{
    ++skipped;
    std::cout << "skipped: " << why << "\n";
    SUCCEED(why);  // a skipped test counts as one with an assertion
}

int main(int argc, char** argv)
{
    // Tests ask for up to 8 threads, on a machine with fewer cores too.
    const tbb::global_control allowed(tbb::global_control::max_allowed_parallelism, 8);
    Catch::Session session;
    session.configData().warnings = static_cast<Catch::WarnAbout::What>(strict);
    // Catch's own status is the number of failures, which could be 77 too.
    if (session.run(argc, argv) != 0) return 1;
    if (skipped > 0) std::cout << skipped << " tests were skipped; the reasons are above\n";
    return skipped > 0 ? 77 : 0;
}
