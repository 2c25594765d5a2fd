#include "review/reason_table.h"

namespace spawnfield {
namespace {

constexpr char number_mark = '\1';

bool is_digit(char c) { return c >= '0' && c <= '9'; }

/// Returns the end of the number that begins at a digit: digits, a point, and an exponent.
std::size_t end_of_number(std::string_view text, std::size_t begin)
{
    std::size_t end = begin;
    const auto skip_digits = [&] {
        while (end < text.size() && is_digit(text[end])) ++end;
    };
    skip_digits();
    if (end + 1 < text.size() && text[end] == '.' && is_digit(text[end + 1])) {
        ++end;
        skip_digits();
    }
    if (end + 2 < text.size() && text[end] == 'e' && (text[end + 1] == '-' || text[end + 1] == '+') &&
        is_digit(text[end + 2])) {
        end += 2;
        skip_digits();
    }
    return end;
}

}  // namespace

void ReasonTable::add(std::string_view reason)
{
    constexpr std::size_t most_texts = 65535;
    std::string text, numbers;
    for (std::size_t at = 0; at < reason.size();) {
        if (!is_digit(reason[at])) {
            text += reason[at] == number_mark || reason[at] == '\n' ? ' ' : reason[at];
            ++at;
            continue;
        }
        const std::size_t end = end_of_number(reason, at);
        text += number_mark;
        numbers.append(reason.substr(at, end - at)) += '\n';
        at = end;
    }
    auto found = known_.find(text);
    if (found == known_.end() && texts_.size() < most_texts) {
        found = known_.emplace(text, std::uint16_t(texts_.size())).first;
        texts_.push_back(text);
    }
    if (found == known_.end()) {  // too many texts: this one is stored as one number
        const std::string whole(1, number_mark);
        found = known_.try_emplace(whole, std::uint16_t(texts_.size())).first;
        if (found->second == texts_.size()) texts_.push_back(whole);
        numbers = std::string(reason) + '\n';
    }
    indices_.push_back(found->second);
    numbers_ += numbers;
}

}  // namespace spawnfield
