#pragma once

#include "base/xml.h"
#include "model/model_paths.h"

#include <map>

namespace spawnfield {

/// Reads an SDF file as XML. Throws FileError with the line unless it is XML with an <sdf> root element and a known
/// version.
SPAWNFIELD_MODULE_API std::unique_ptr<tinyxml2::XMLDocument> read_sdf_xml(const std::filesystem::path& file);

/// Returns the file that an <include> with this <uri> means in a file of `folder`; empty if it is not found. Throws
/// FileError for a folder that is not a model's.
std::filesystem::path included_file(const std::string& uri, const std::filesystem::path& folder, ModelPaths& paths);

/// Includes whose model is not found. The key is the URI; the values are the place of the first such include ("FILE:
/// line 3") and their number.
using MissingIncludes = std::map<std::string, std::pair<std::string, std::size_t>>;

/// Returns, for example, "FILE: line 3: <include> <uri> model://table is not found (2 includes)".
std::string text_of_missing(const MissingIncludes::value_type& missing);

/// Throws FileError that lists all missing includes and the remedy.
[[noreturn]] void refuse_missing(const std::filesystem::path& file, const MissingIncludes& missing);

/// Checks `document`, which is the content of `file`, and each file that it includes at any depth, once. Returns the
/// missing includes. Throws FileError for numbers that are malformed (sdf_numbers.h), and for a file that includes
/// itself, because libsdformat would run until memory ends; the message shows the circle.
SPAWNFIELD_MODULE_API MissingIncludes check_includes(const std::filesystem::path& file,
                                                     const tinyxml2::XMLDocument& document, ModelPaths& paths);

}  // namespace spawnfield
