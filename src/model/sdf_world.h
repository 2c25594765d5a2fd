#pragma once

#include "model/sdf_model.h"

namespace spawnfield {

/// An SDF world or model with all that it includes.
struct SdfWorld {
    std::string name;
    std::vector<CollisionBody> bodies;     ///< in the world's frame; a lone model stands at its own <pose>
    std::vector<std::string> bare_models;  ///< models that have no collision
    std::size_t model_count = 0, actor_count = 0, road_count = 0;
    std::size_t hollow = 0, untouchable = 0;  ///< as SdfContent
    std::vector<std::string> missing;  ///< includes that are not found and what libsdformat leaves out, a line each
    std::vector<std::string> notices;
};

/// Reads .sdf, .world, or a model's file. Plain includes of a world (a URI, and nothing that hangs on frames) are
/// taken out of its text and each model is parsed once, however often it is included; all else is left to
/// libsdformat. Throws FileError: includes that are not found, with all of them, unless allow_missing; malformed XML
/// (with its line), includes that lead back to themselves, <population>, and as read_sdf_file.
SdfWorld read_sdf_world(const std::filesystem::path& file, ModelPaths& paths, bool allow_missing);

}  // namespace spawnfield
