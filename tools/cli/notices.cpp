#include "notices.h"

#include <algorithm>
#include <cctype>
#include <map>

namespace spawnfield::cli {
namespace {

constexpr std::size_t most_shown = 5;  // names of further notices of one kind

/// Returns the words between spaces, without the colon or comma behind them. Text in quotation marks or parentheses is
/// one word, with its spaces.
std::vector<std::string> split_at_spaces(const std::string& text)
{
    std::vector<std::string> out(1);
    bool is_quoted = false;
    int depth = 0;
    for (const char c : text) {
        if (c == '"') is_quoted = !is_quoted;
        depth += c == '(' ? 1 : c == ')' && depth > 0 ? -1 : 0;
        if (c == ' ' && !is_quoted && depth == 0)
            out.emplace_back();
        else
            out.back() += c;
    }
    for (std::string& word : out) word.resize(word.find_last_not_of(":,;") + 1);
    return out;
}

/// Returns whether the word is a name, a path or a number. Notices of one kind differ only in such words.
bool is_detail(const std::string& word)
{
    return word.find_first_of("\"/0123456789") != std::string::npos || word.find("::") != std::string::npos;
}

/// Returns the text with "*" in place of each detail, and without counts in parentheses, which not every notice of a
/// kind has.
std::string kind_of(const std::vector<std::string>& words)
{
    std::string out;
    for (const std::string& word : words)
        if (!is_detail(word))
            out += word + " ";
        else if (word.front() != '(')
            out += "* ";
    return out;
}

/// Returns the first name or path that the example does not contain; empty if there is none.
std::string subject_of(const std::vector<std::string>& words, const std::vector<std::string>& example)
{
    const auto is_letter = [](unsigned char c) { return std::isalpha(c) != 0; };
    const auto is_subject = [&](const std::string& word) {
        return is_detail(word) && word.front() != '(' && std::any_of(word.begin(), word.end(), is_letter) &&
               std::find(example.begin(), example.end(), word) == example.end();
    };
    const auto found = std::find_if(words.begin(), words.end(), is_subject);
    return found == words.end() ? "" : *found;
}

struct Kind {
    std::string first;
    std::vector<std::string> words;  ///< of the first
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
        std::vector<std::string> words = split_at_spaces(notice);
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
