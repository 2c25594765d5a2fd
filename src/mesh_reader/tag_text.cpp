#include "mesh_reader/tag_text.h"

#include <algorithm>

namespace spawnfield {

std::string attribute(std::string_view element, std::string_view name)
{
    for (std::size_t start = element.find(name); start != std::string_view::npos;
         start = element.find(name, start + 1)) {
        std::size_t next = start + name.size();
        while (next < element.size() && is_xml_space(element[next])) ++next;
        if (start == 0 || !is_xml_space(element[start - 1]) || next == element.size() || element[next] != '=') continue;
        const std::size_t open = element.find_first_of("\"'", next);
        if (open == std::string_view::npos) return {};
        const std::size_t close = std::min(element.find(element[open], open + 1), element.size());
        return std::string(element.substr(open + 1, close - open - 1));
    }
    return {};
}

}  // namespace spawnfield
