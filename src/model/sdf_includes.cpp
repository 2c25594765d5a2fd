#include "model/sdf_includes.h"

#include "base/number.h"
#include "model/sdf_numbers.h"

#include <spawnfield/error.h>

#include <algorithm>

namespace spawnfield {
namespace {

namespace fs = std::filesystem;

class IncludeWalk {
public:
    explicit IncludeWalk(ModelPaths& paths) : paths_(paths) {}

    /// Returns the number of includes in the file, counting those in the included files.
    std::size_t visit(const fs::path& file, const tinyxml2::XMLDocument& document)
    {
        constexpr std::size_t most = 100000;  // with more, libsdformat takes hours
        std::size_t count = 0;
        check_numbers(file, *document.RootElement());
        stack_.push_back(fs::weakly_canonical(file));
        for_each_element(*document.RootElement(), [&](const Xml& include) {
            if (std::string(include.Name()) != "include") return;
            const std::string place = file.string() + ": " + line_of(include);
            const std::string uri = text_of(include, "uri");
            if (uri.empty()) throw FileError(place + "<include>", "has no <uri>, needs the model that it includes");
            const fs::path found = find(uri, file.parent_path(), place);
            if (found.empty()) {
                ++missing_.try_emplace(uri, place.substr(0, place.size() - 2), std::size_t{0}).first->second.second;
                return;
            }
            const fs::path canonical = fs::weakly_canonical(found);
            const auto again = std::find(stack_.begin(), stack_.end(), canonical);
            if (again != stack_.end()) {
                std::string chain;
                for (auto link = again; link != stack_.end(); ++link) chain += link->string() + " includes ";
                throw FileError(place + "<include> <uri> " + uri, "includes itself: " + chain + canonical.string());
            }
            const auto known = counts_.find(canonical);
            const std::size_t within = known != counts_.end()         ? known->second
                                       : found.extension() == ".urdf" ? 0
                                                                      : visit(found, *read_sdf_xml(found));
            counts_[canonical] = within;
            count += 1 + within;
            if (count > most)
                throw FileError(place + "<include> <uri> " + uri,
                                "makes more than " + std::to_string(most) + " includes in total, needs fewer");
        });
        stack_.pop_back();
        return count;
    }

    MissingIncludes take() { return std::move(missing_); }

private:
    fs::path find(const std::string& uri, const fs::path& folder, const std::string& place)
    {
        try {
            return included_file(uri, folder, paths_);
        } catch (const FileError& error) {  // for example, it is in no folder from which files may be read
            throw FileError(place + "<include> <uri> " + uri, std::string("cannot be used: ") + error.what());
        }
    }

    ModelPaths& paths_;
    std::vector<fs::path> stack_;  ///< from the first file to this one
    std::map<fs::path, std::size_t> counts_;
    MissingIncludes missing_;
};

}  // namespace

std::unique_ptr<tinyxml2::XMLDocument> read_sdf_xml(const fs::path& file)
{
    auto document = read_xml(file, "an <sdf> element");
    const Xml& root = *document->RootElement();
    const std::string name = root.Name();
    const auto refuse = [&](const std::string& what) { throw FileError(file.string(), line_of(root) + what); };
    if (name == "robot") refuse("<robot> is URDF; rename the file so that it ends in .urdf");
    if (name != "sdf" && name != "gazebo") refuse("the root element is <" + name + ">, needs <sdf version=\"…\">");
    const char* const version = root.Attribute("version");
    if (version == nullptr) refuse("<" + name + "> has no version, needs one, for example version=\"1.6\"");
    double value = 0;
    if (!parse_number(version, value) || !(value >= 1 && value < 3))
        refuse("<" + name + "> has version \"" + version + "\", needs 1.0 to 2.x, for example version=\"1.6\"");
    return document;
}

fs::path included_file(const std::string& uri, const fs::path& folder, ModelPaths& paths)
{
    return model_file_of(paths.find(uri, folder));
}

std::string text_of_missing(const MissingIncludes::value_type& missing)
{
    const auto& [uri, place] = missing;
    return place.first + ": <include> <uri> " + uri + " is not found" +
           (place.second > 1 ? " (" + std::to_string(place.second) + " includes)" : "");
}

void refuse_missing(const fs::path& file, const MissingIncludes& missing)
{
    std::string list;
    bool has_fuel = false;
    const std::string prefix = file.string() + ": ";
    for (const MissingIncludes::value_type& entry : missing) {
        const std::string words = text_of_missing(entry);
        list += "\n  " + (words.starts_with(prefix) ? words.substr(prefix.size()) : words);
        has_fuel = has_fuel || entry.first.starts_with("http");
    }
    const bool is_one = missing.size() == 1;
    throw FileError(file.string(), std::to_string(missing.size()) +
                                       (is_one ? " model that it includes is" : " models that it includes are") +
                                       " not found; give the folder that contains " + (is_one ? "it" : "them") +
                                       " with --model-path" +
                                       (has_fuel ? ", download models of Fuel with `gz fuel download -u URI`" : "") +
                                       ", or ignore " + (is_one ? "it" : "them") + " with --allow-missing:" + list);
}

MissingIncludes check_includes(const fs::path& file, const tinyxml2::XMLDocument& document, ModelPaths& paths)
{
    IncludeWalk walk(paths);
    walk.visit(file, document);
    return walk.take();
}

}  // namespace spawnfield
