#pragma once

#include "model/sdf_model.h"

namespace spawnfield {

/// The content of an SDF world or model, with all that it includes.
struct SdfWorld {
    std::string name;
    std::vector<CollisionBody> bodies;     ///< in the world's frame; a lone model stands at its own <pose>
    std::vector<std::string> bare_models;  ///< models that have no collision
    std::size_t model_count = 0, actor_count = 0, road_count = 0;
    std::size_t hollow = 0, untouchable = 0;  ///< as in SdfContent
    /// Messages about includes that are not found and about content that libsdformat ignores.
    std::vector<std::string> missing;
    std::vector<std::string> notices;
};

/// Reads a .sdf or .world file, or the file of a model. For speed, this function itself handles each <include> of a
/// world whose pose, and whose model's pose, do not depend on another frame: it removes these from the text that
/// libsdformat reads, and parses each of their models once, however often it is included. libsdformat handles all other
/// includes. Throws FileError for includes that are not found, unless allow_missing (the message lists all of them),
/// for malformed XML (the message names the line), for files that include themselves, for <population>, and as
/// read_sdf_file() does.
SdfWorld read_sdf_world(const std::filesystem::path& file, ModelPaths& paths, bool allow_missing);

}  // namespace spawnfield
