#include "mesh_reader/obj_text.h"

#include "base/text.h"

#include <algorithm>
#include <charconv>
#include <cctype>

namespace spawnfield {
namespace {

constexpr std::string_view own_name = "node:";

bool is_blank(char c) { return c == ' ' || c == '\t'; }

/// Goes through the lines and rewrites those that assimp would misread.
class ObjRewriter {
public:
    explicit ObjRewriter(std::string_view text) : text_(text) {}

    ObjText rewrite(std::string&& whole)
    {
        for (std::size_t start = 0; start < text_.size();) {
            const std::size_t end = std::min(text_.find('\n', start), text_.size());
            line(start, end);
            start = end + 1;
        }
        if (copied_ == 0) return {std::move(whole), std::move(names_)};
        out_.append(text_.substr(copied_));
        return {std::move(out_), std::move(names_)};
    }

private:
    void line(std::size_t start, std::size_t end)
    {
        if (!is_continued_) start = without_indent(start, end);
        const std::string_view whole = text_.substr(start, end - start);
        const char kind = is_continued_                                                 ? kind_
                          : whole.size() > 1 && (is_blank(whole[1]) || whole[0] == 'v') ? whole[0]
                                                                                        : ' ';
        if (kind == 'v')
            add_leading_zeros(start, end);
        else if (!is_continued_ && (kind == 'o' || kind == 'g'))
            name(start, end);
        const std::size_t last = whole.find_last_not_of('\r');
        is_continued_ = last != std::string_view::npos && whole[last] == '\\';
        kind_ = kind;
    }

    /// Removes the indentation of a line, because assimp ignores indented lines. Returns where the rest starts.
    std::size_t without_indent(std::size_t start, std::size_t end)
    {
        const std::size_t first = std::min(text_.find_first_not_of(" \t", start), end);
        if (first > start) replace(start, first, "");
        return first;
    }

    void name(std::size_t start, std::size_t end)
    {
        const std::string found = trimmed(text_.substr(start + 1, end - start - 1));
        if (found.empty() || found.back() == '\\') return;  // assimp ignores a line without a name
        if (names_.empty() || found != current_) names_.push_back(found);
        current_ = found;
        replace(start + 2, end,
                std::string(own_name) + std::to_string(names_.size() - 1) + (text_[end - 1] == '\r' ? "\r" : ""));
    }

    void add_leading_zeros(std::size_t start, std::size_t end)
    {
        for (std::size_t point = text_.find('.', start); point < end; point = text_.find('.', point + 1)) {
            const char before = point > start ? text_[point - 1] : ' ';
            const bool has_digit = point + 1 < end && std::isdigit(static_cast<unsigned char>(text_[point + 1]));
            if (has_digit && (is_blank(before) || before == '-' || before == '+')) replace(point, point, "0");
        }
    }

    void replace(std::size_t begin, std::size_t end, std::string_view with)
    {
        out_.append(text_.substr(copied_, begin - copied_));
        out_.append(with);
        copied_ = end;
    }

    const std::string_view text_;
    std::string out_;
    std::vector<std::string> names_;
    std::string current_;        ///< name in the last `o` or `g` line; empty: none yet
    std::size_t copied_ = 0;     ///< bytes of the text that are already in out_, rewritten
    bool is_continued_ = false;  ///< the line before ended with a backslash
    char kind_ = ' ';            ///< first letter of the line, 'v' also for vt and vn
};

}  // namespace

ObjText readable_obj(std::string text)
{
    ObjRewriter rewriter(text);
    return rewriter.rewrite(std::move(text));
}

std::string obj_name(const ObjText& obj, const std::string& node)
{
    if (!node.starts_with(own_name)) return node;
    std::size_t index = 0;
    const auto [end, error] = std::from_chars(node.data() + own_name.size(), node.data() + node.size(), index);
    return error == std::errc{} && end == node.data() + node.size() && index < obj.names.size() ? obj.names[index]
                                                                                                : node;
}

}  // namespace spawnfield
