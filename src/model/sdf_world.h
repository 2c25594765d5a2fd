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

/// Reads a .sdf or .world file, or the file of a model. An <include> of a world is plain if neither its pose nor that
/// of its model depends on a frame. Plain includes are removed from the text that libsdformat reads, and each of their
/// models is parsed once, however often it is included; libsdformat resolves all others. Throws FileError for: includes
/// that are not found (the message lists all), unless allow_missing; malformed XML, with the line; files that include
/// themselves; <population>; and as read_sdf_file().
SdfWorld read_sdf_world(const std::filesystem::path& file, ModelPaths& paths, bool allow_missing);

}  // namespace spawnfield
