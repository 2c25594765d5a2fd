#pragma once

#include "base/xml.h"
#include "model/model_paths.h"

#include <map>

namespace spawnfield {

/// A file that is XML and says that it is SDF. Throws FileError with the line.
SPAWNFIELD_MODULE_API std::unique_ptr<tinyxml2::XMLDocument> read_sdf_xml(const std::filesystem::path& file);

/// The file that an <include> of this <uri> in a file of `folder` means; nothing if it is nowhere. Throws FileError for
/// a folder that is no model's.
std::filesystem::path included_file(const std::string& uri, const std::filesystem::path& folder, ModelPaths& paths);

/// Includes that lead nowhere, by URI: where the first stands ("FILE: line 3"), and how many there are.
using MissingIncludes = std::map<std::string, std::pair<std::string, std::size_t>>;

/// "FILE: line 3: <include> <uri> model://table is not found (2 includes)".
std::string words_of(const MissingIncludes::value_type& missing);

/// Throws FileError with all of them and what to do.
[[noreturn]] void refuse_missing(const std::filesystem::path& file, const MissingIncludes& missing);

/// Looks at `document`, which is what the file holds, and at each file that it includes at any depth, once. Throws
/// FileError for numbers that are none, and with the circle for a file that includes itself: libsdformat would go on
/// until memory ends.
SPAWNFIELD_MODULE_API MissingIncludes check_includes(const std::filesystem::path& file,
                                                     const tinyxml2::XMLDocument& document, ModelPaths& paths);

}  // namespace spawnfield
