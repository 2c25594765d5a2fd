#pragma once

#include "base/parallel.h"

#include <algorithm>
#include <functional>
#include <string>
#include <string_view>
#include <vector>

namespace spawnfield {

inline constexpr std::size_t batch_lines = 1 << 16;  // lines whose texts several threads make before they are written

/// Passes the texts of `count` lines to `sink`, in order. append(text, first, end) appends lines; several threads call
/// it. `texts` is memory that is used again.
template <class Append>
void write_lines(std::size_t count, int threads, const std::function<void(std::string_view)>& sink,
                 std::vector<std::string>& texts, const Append& append)
{
    constexpr std::size_t text_lines = 1 << 12;
    for (std::size_t from = 0; from < count; from += batch_lines) {
        const std::size_t end = std::min(count, from + batch_lines);
        texts.resize((end - from + text_lines - 1) / text_lines);
        parallel_for(texts.size(), threads, {}, [&](std::size_t i) {
            texts[i].clear();
            append(texts[i], from + i * text_lines, std::min(end, from + (i + 1) * text_lines));
        });
        for (const std::string& text : texts) sink(text);
    }
}

}  // namespace spawnfield
