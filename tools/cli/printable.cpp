#include "printable.h"

#include <cstdio>

namespace spawnfield::cli {

std::string printable(const std::string& text, bool keeps_lines)
{
    std::string out;
    for (std::size_t i = 0; i < text.size(); ++i) {
        const auto c = static_cast<unsigned char>(text[i]);
        const bool is_c1 = c == 0xc2 && i + 1 < text.size() && static_cast<unsigned char>(text[i + 1]) < 0xa0;
        const bool is_kept = keeps_lines && (c == '\n' || c == '\t');
        if (!is_c1 && (is_kept || (c >= 0x20 && c != 0x7f))) {
            out += char(c);
            continue;
        }
        char code[8];
        std::snprintf(code, sizeof code, "\\x%02x", is_c1 ? static_cast<unsigned char>(text[++i]) : c);
        out += code;
    }
    return out;
}

}  // namespace spawnfield::cli
