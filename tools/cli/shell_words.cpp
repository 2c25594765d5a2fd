#include "shell_words.h"

#include <algorithm>
#include <cctype>
#include <cstring>

namespace spawnfield::cli {
namespace {

std::string quoted_if_needed(const std::string& word)
{
    const bool plain = !word.empty() && std::all_of(word.begin(), word.end(), [](unsigned char c) {
        return std::isalnum(c) || std::strchr("-_./:,=@+%", c);
    });
    if (plain) return word;
    std::string out = "'";
    for (const char c : word) out += c == '\'' ? "'\\''" : std::string(1, c);
    return out + "'";
}

}  // namespace

std::string shell_line(const std::vector<std::string>& words)
{
    std::string out;
    for (const std::string& word : words) out += (out.empty() ? "" : " ") + quoted_if_needed(word);
    return out;
}

}  // namespace spawnfield::cli
