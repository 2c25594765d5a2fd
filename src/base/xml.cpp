#include "base/xml.h"

#include "base/text.h"

#include <spawnfield/error.h>
#include <spawnfield/input_file.h>

#include <algorithm>
#include <cstring>

namespace spawnfield {

std::unique_ptr<tinyxml2::XMLDocument> read_xml(const std::filesystem::path& file, const std::string& expected)
{
    const std::string text = read_file(file);
    auto document = std::make_unique<tinyxml2::XMLDocument>();
    const tinyxml2::XMLError error = document->Parse(text.data(), text.size());
    if (error == tinyxml2::XML_ERROR_EMPTY_DOCUMENT ||
        (error == tinyxml2::XML_SUCCESS && document->RootElement() == nullptr))
        throw FileError(file.string(), "is empty, needs " + expected);
    if (error == tinyxml2::XML_SUCCESS) return document;
    std::string name = lower_case(document->ErrorName());
    std::replace(name.begin(), name.end(), '_', ' ');
    const std::string line = document->ErrorLineNum() > 0 ? "line " + std::to_string(document->ErrorLineNum()) + ": "
                                                          : "";
    throw FileError(file.string(),
                    line + "is not valid XML (" + name + ")" +
                        (error == tinyxml2::XML_ELEMENT_DEPTH_EXCEEDED ? ": elements may be nested at most 500 deep"
                                                                       : ": is a tag not closed, or misspelt?"));
}

std::string text_of(const Xml& parent, const char* name)
{
    const Xml* const child = parent.FirstChildElement(name);
    return child != nullptr && child->GetText() != nullptr ? trimmed(child->GetText()) : "";
}

std::string attribute_of(const Xml& element, const char* name)
{
    const char* const value = element.Attribute(name);
    return value == nullptr ? "" : value;
}

bool is_named(const Xml& element, const char* name) { return std::strcmp(element.Name(), name) == 0; }

std::string line_of(const Xml& element) { return "line " + std::to_string(element.GetLineNum()) + ": "; }

}  // namespace spawnfield
