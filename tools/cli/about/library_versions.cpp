#include "library_versions.h"

#include <spawnfield/types.h>

#include <libqhull_r/libqhull_r.h>
#include <oneapi/tbb/version.h>
#include <png.h>
#include <xxhash.h>
#include <zlib.h>

#include <algorithm>
#include <vector>

namespace spawnfield::cli {
namespace {

struct LibraryVersion {
    std::string name, version;
    std::string package_version = {};  ///< of dpkg; empty if the library is not in a package
};

#include "about/library_list.h"

/// Returns the first word of the text that begins with a digit.
std::string number_in(const std::string& text)
{
    for (std::size_t at = text.find_first_of("0123456789"); at != std::string::npos;) {
        if (at == 0 || text[at - 1] == ' ') return text.substr(at, text.find_first_of(" \n", at) - at);
        at = text.find_first_of("0123456789", at + 1);
    }
    return text;
}

/// Returns 0.8.1 for 801.
std::string dotted(unsigned number)
{
    return std::to_string(number / 10000) + "." + std::to_string(number / 100 % 100) + "." +
           std::to_string(number % 100);
}

std::vector<LibraryVersion> loaded_versions()
{
    return {{"libpng", png_get_libpng_ver(nullptr)},
            {"oneTBB", TBB_runtime_version()},
            {"qhull", number_in(qh_version2)},
            {"xxHash", dotted(XXH_versionNumber())},
            {"zlib", zlibVersion()}};
}

}  // namespace

std::string version_text()
{
    const std::vector<LibraryVersion> loaded = loaded_versions();
    std::string out = version() + "\n\nlibraries that are loaded now:\n";
    for (const LibraryVersion& library : loaded) out += "  " + library.name + " " + library.version + "\n";
    out += "\nother libraries, as found when spawnfield was built:";
    for (const LibraryVersion& library : versions_at_build) {
        const auto is_it = [&](const LibraryVersion& other) { return other.name == library.name; };
        if (std::any_of(loaded.begin(), loaded.end(), is_it)) continue;
        const std::string& package = library.package_version;
        out += "\n  " + library.name + " " + library.version + (package.empty() ? "" : " (package " + package + ")");
    }
    return out;
}

}  // namespace spawnfield::cli
