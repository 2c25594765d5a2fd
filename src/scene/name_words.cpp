#include "scene/name_words.h"

#include <cctype>

namespace spawnfield {
namespace {

/// Returns character i of the name; 0 after its end.
unsigned char char_at(const std::string& name, std::size_t i)
{
    return i < name.size() ? static_cast<unsigned char>(name[i]) : 0;
}

bool begins_word(const std::string& name, std::size_t i)
{
    const unsigned char before = i == 0 ? 0 : char_at(name, i - 1), here = char_at(name, i),
                        after = char_at(name, i + 1);
    if (std::isalpha(before) == 0 || std::isalpha(here) == 0)
        return std::isdigit(before) == 0 || std::isdigit(here) == 0;
    return std::isupper(here) != 0 && (std::islower(before) != 0 || std::islower(after) != 0);
}

}  // namespace

std::vector<std::string> words_of_name(const std::string& name)
{
    std::vector<std::string> out;
    for (std::size_t i = 0; i < name.size(); ++i) {
        if (std::isalnum(char_at(name, i)) == 0) continue;
        if (out.empty() || begins_word(name, i)) out.emplace_back();
        out.back() += static_cast<char>(std::tolower(char_at(name, i)));
    }
    return out;
}

}  // namespace spawnfield
