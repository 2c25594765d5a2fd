#include "scene/sdf_includes.h"

#include "scene/model_paths.h"

#include <spawnfield/error.h>

#include <algorithm>
#include <cctype>
#include <fstream>
#include <iterator>
#include <set>
#include <string>

namespace spawnfield {
namespace {

namespace fs = std::filesystem;

std::string text_without_comments(const fs::path& file)
{
    std::ifstream stream(file, std::ios::binary);
    std::string text{std::istreambuf_iterator<char>(stream), {}};
    for (std::size_t start = 0; (start = text.find("<!--", start)) != std::string::npos;) {
        const std::size_t end = text.find("-->", start);
        text.erase(start, end == std::string::npos ? std::string::npos : end + 3 - start);
    }
    return text;
}

/// What stands in elements of this name, trimmed; attributes are passed over.
std::vector<std::string> contents(const std::string& text, const std::string& element)
{
    std::vector<std::string> out;
    const std::string open = "<" + element, close = "</" + element + ">";
    for (std::size_t at = 0; (at = text.find(open, at)) != std::string::npos;) {
        at += open.size();
        if (at >= text.size() || (text[at] != '>' && !std::isspace(static_cast<unsigned char>(text[at])))) continue;
        const std::size_t start = text.find('>', at), end = text.find(close, at);
        if (start == std::string::npos || end == std::string::npos || start >= end) break;
        std::string inside = text.substr(start + 1, end - start - 1);
        const auto is_space = [](unsigned char c) { return std::isspace(c) != 0; };
        inside.erase(std::find_if_not(inside.rbegin(), inside.rend(), is_space).base(), inside.end());
        inside.erase(inside.begin(), std::find_if_not(inside.begin(), inside.end(), is_space));
        out.push_back(std::move(inside));
        at = end;
    }
    return out;
}

class Includes {
public:
    explicit Includes(const std::vector<fs::path>& folders) : folders_(folders) {}

    void visit(const fs::path& file)
    {
        const fs::path place = fs::weakly_canonical(file);
        const auto before = std::find(way_.begin(), way_.end(), place);
        if (before != way_.end()) {
            std::string names;
            for (auto step = before; step != way_.end(); ++step) names += step->string() + " > ";
            throw FileError(way_.front().string(), "includes itself without end: " + names + place.string());
        }
        if (!seen_.insert(place).second) return;
        way_.push_back(place);
        for (const std::string& include : contents(text_without_comments(place), "include"))
            for (const std::string& uri : contents(include, "uri")) follow(find_uri(uri, place.parent_path(), folders_));
        way_.pop_back();
    }

private:
    void follow(const fs::path& found)
    {
        if (fs::is_regular_file(found)) return visit(found);
        if (!fs::is_regular_file(found / "model.config")) return;
        for (const std::string& name : contents(text_without_comments(found / "model.config"), "sdf"))
            if (fs::is_regular_file(found / name)) visit(found / name);
    }

    const std::vector<fs::path>& folders_;
    std::set<fs::path> seen_;
    std::vector<fs::path> way_;  ///< from the first file to this one
};

}  // namespace

void refuse_cyclic_includes(const fs::path& file, const std::vector<fs::path>& folders) { Includes(folders).visit(file); }

}  // namespace spawnfield
