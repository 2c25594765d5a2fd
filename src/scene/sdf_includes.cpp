#include "scene/sdf_includes.h"

#include "base/text.h"
#include "scene/sdf_numbers.h"

#include <spawnfield/error.h>

#include <algorithm>
#include <set>

namespace spawnfield {
namespace {

namespace fs = std::filesystem;

class IncludeWalk {
public:
    explicit IncludeWalk(ModelPaths& paths) : paths_(paths) {}

    void visit(const fs::path& file, const tinyxml2::XMLDocument& document)
    {
        check_numbers(file, *document.RootElement());
        stack_.push_back(fs::weakly_canonical(file));
        for_each_element(*document.RootElement(), [&](const Xml& include) {
            if (std::string(include.Name()) != "include") return;
            const std::string place = file.string() + ": " + line_of(include);
            const std::string uri = text_of(include, "uri");
            if (uri.empty()) throw FileError(place + "<include>", "has no <uri>, needs the model that it includes");
            const fs::path found = included_file(uri, file.parent_path(), paths_);
            if (found.empty()) {
                ++missing_.try_emplace(uri, place.substr(0, place.size() - 2), std::size_t{0}).first->second.second;
                return;
            }
            const fs::path canonical = fs::weakly_canonical(found);
            const auto again = std::find(stack_.begin(), stack_.end(), canonical);
            if (again != stack_.end()) {
                std::string chain;
                for (auto link = again; link != stack_.end(); ++link) chain += link->string() + " includes ";
                throw FileError(place + "<include> <uri> " + uri, "leads back to itself: " + chain + canonical.string());
            }
            if (!visited_.insert(canonical).second || found.extension() == ".urdf") return;
            visit(found, *read_sdf_xml(found));
        });
        stack_.pop_back();
    }

    MissingIncludes take() { return std::move(missing_); }

private:
    ModelPaths& paths_;
    std::vector<fs::path> stack_;  ///< from the first file to this one
    std::set<fs::path> visited_;
    MissingIncludes missing_;
};

}  // namespace

std::unique_ptr<tinyxml2::XMLDocument> read_sdf_xml(const fs::path& file)
{
    auto document = std::make_unique<tinyxml2::XMLDocument>();
    const auto refuse = [&](int line, const std::string& what) {
        throw FileError(file.string(), (line > 0 ? "line " + std::to_string(line) + ": " : "") + what);
    };
    const tinyxml2::XMLError error = document->LoadFile(file.c_str());
    if (error == tinyxml2::XML_ERROR_FILE_NOT_FOUND || error == tinyxml2::XML_ERROR_FILE_COULD_NOT_BE_OPENED || error == tinyxml2::XML_ERROR_FILE_READ_ERROR)
        refuse(0, "cannot be read");
    if (error == tinyxml2::XML_ERROR_EMPTY_DOCUMENT || (error == tinyxml2::XML_SUCCESS && document->RootElement() == nullptr))
        refuse(0, "is empty, needs an <sdf> element");
    if (error != tinyxml2::XML_SUCCESS) {
        std::string name = lower_case(document->ErrorName());
        std::replace(name.begin(), name.end(), '_', ' ');
        refuse(document->ErrorLineNum(), "is no valid XML (" + name + "): is a tag left open or misspelt?");
    }
    const Xml& root = *document->RootElement();
    const std::string name = root.Name();
    if (name == "robot") refuse(root.GetLineNum(), "<robot> is URDF; give the file the ending .urdf");
    if (name != "sdf" && name != "gazebo") refuse(root.GetLineNum(), "<" + name + "> stands where <sdf version=\"…\"> needs to");
    if (root.Attribute("version") == nullptr) refuse(root.GetLineNum(), "<" + name + "> has no version, needs such as version=\"1.6\"");
    return document;
}

std::string text_of(const Xml& parent, const char* name)
{
    const Xml* const child = parent.FirstChildElement(name);
    return child != nullptr && child->GetText() != nullptr ? trimmed(child->GetText()) : "";
}

std::string line_of(const Xml& element) { return "line " + std::to_string(element.GetLineNum()) + ": "; }

fs::path included_file(const std::string& uri, const fs::path& folder, ModelPaths& paths)
{
    const fs::path found = paths.find(uri, folder);
    return found.empty() || !fs::is_directory(found) ? found : sdf_file_of(found);
}

MissingIncludes check_includes(const fs::path& file, const tinyxml2::XMLDocument& document, ModelPaths& paths)
{
    IncludeWalk walk(paths);
    walk.visit(file, document);
    return walk.take();
}

}  // namespace spawnfield
