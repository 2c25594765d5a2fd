#include "notices.h"

#include <algorithm>
#include <cctype>
#include <map>

namespace spawnfield::cli {
namespace {

constexpr std::size_t most_shown = 5;  // of what further notices of a kind are about

/// Words between spaces; text in quotation marks is in one word, with its spaces.
std::vector<std::string> words_of(const std::string& text)
{
    std::vector<std::string> out(1);
    bool is_quoted = false;
    for (const char c : text) {
        if (c == '"') is_quoted = !is_quoted;
        if (c == ' ' && !is_quoted) out.emplace_back();
        else out.back() += c;
    }
    return out;
}

/// Whether the word is a name, a path or a number, which differ between notices of one kind.
bool is_detail(const std::string& word)
{
    return word.find_first_of("\"/0123456789") != std::string::npos || word.find("::") != std::string::npos;
}

/// The text with "*" in place of each detail.
std::string kind_of(const std::vector<std::string>& words)
{
    std::string out;
    for (const std::string& word : words) out += (is_detail(word) ? "*" : word) + " ";
    return out;
}

/// The first detail that the example does not have, without a colon or comma behind it; "" if there is none.
std::string subject_of(const std::vector<std::string>& words, const std::vector<std::string>& example)
{
    for (std::size_t i = 0; i < std::min(words.size(), example.size()); ++i) {
        if (words[i] == example[i]) continue;
        const std::size_t last = words[i].find_last_not_of(":,;");
        return words[i].substr(0, last + 1);
    }
    return "";
}

struct Kind {
    std::string first;
    std::vector<std::string> words;     ///< of the first
    std::size_t more = 0;
    std::vector<std::string> subjects;  ///< of the next ones
};

std::string text_of(const Kind& kind)
{
    if (kind.more == 0) return kind.first;
    std::string out = kind.first + "\n  ... and " + std::to_string(kind.more) + " more like it";
    for (std::size_t i = 0; i < kind.subjects.size(); ++i) out += (i == 0 ? ": " : ", ") + kind.subjects[i];
    return out + (kind.subjects.size() < kind.more && !kind.subjects.empty() ? ", ... (`info --json` lists all)" : "");
}

}  // namespace

std::vector<std::string> grouped(const std::vector<std::string>& notices)
{
    std::vector<Kind> kinds;
    std::map<std::string, std::size_t> index;
    for (const std::string& notice : notices) {
        std::vector<std::string> words = words_of(notice);
        const auto [known, is_new] = index.try_emplace(kind_of(words), kinds.size());
        if (is_new) {
            kinds.push_back({notice, std::move(words), 0, {}});
            continue;
        }
        Kind& kind = kinds[known->second];
        ++kind.more;
        const std::string subject = subject_of(words, kind.words);
        const bool is_known = std::find(kind.subjects.begin(), kind.subjects.end(), subject) != kind.subjects.end();
        if (!subject.empty() && !is_known && kind.subjects.size() < most_shown) kind.subjects.push_back(subject);
    }
    std::vector<std::string> out;
    for (const Kind& kind : kinds) out.push_back(text_of(kind));
    return out;
}

}  // namespace spawnfield::cli
