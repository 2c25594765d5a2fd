#include "review/page_shell.h"

#ifdef SPAWNFIELD_REVIEW_PAGE

// The assembler puts the file into the library. Its end has a symbol, too.
__asm__(
    ".section .rodata\n"
    "spawnfield_review_page: .incbin \"" SPAWNFIELD_REVIEW_PAGE
    "\"\n"
    "spawnfield_review_page_end:\n"
    ".previous\n");

extern "C" const char spawnfield_review_page[] __attribute__((visibility("hidden")));
extern "C" const char spawnfield_review_page_end[] __attribute__((visibility("hidden")));

namespace spawnfield {

std::string_view page_shell() { return {spawnfield_review_page, spawnfield_review_page_end}; }

}  // namespace spawnfield

#else

namespace spawnfield {

std::string_view page_shell() { return {}; }

}  // namespace spawnfield

#endif

namespace spawnfield {

std::string_view page_policy()
{
    constexpr std::string_view name = "http-equiv=\"Content-Security-Policy\" content=\"";
    const std::string_view shell = page_shell();
    const std::size_t start = shell.find(name);
    if (start == shell.npos) return {};
    const std::string_view rest = shell.substr(start + name.size());
    return rest.substr(0, rest.find('"'));
}

}  // namespace spawnfield
