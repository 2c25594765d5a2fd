#pragma once

#include "model/collision_geometry.h"
#include "model/model_paths.h"

#include <optional>

namespace spawnfield {

/// What an SDF file, or a part of one, puts into the world.
struct SdfContent {
    std::string name;  ///< of the world, or of the model if there is no world
    std::vector<CollisionBody> bodies;
    std::vector<std::string> bare_models;  ///< models that have no collision
    std::size_t model_count = 0;           ///< of the outermost models
    std::size_t hollow = 0;                ///< collisions without a shape; they are left out
    std::size_t untouchable = 0;           ///< collisions that touch nothing: a <collide_bitmask> of 0, or
                                           ///< <collide_without_contact>; they are left out
    std::vector<std::string> lost;         ///< what libsdformat leaves out
    std::vector<std::string> complaints;   ///< of libsdformat about what does not matter here, or not enough to end
    /// Of a file that holds a model: the model's own pose; its bodies' poses are seen from the model then.
    Pose pose;
    bool is_plain_model = false;  ///< a model whose pose hangs on no frame: what includes it may say where it is
};

/// By libsdformat, in the file's or the model's frame. `text` stands for the file's text, without what was taken out of
/// it. Frames, relative_to, placement frames and nested includes are its business. Throws FileError for a file that it
/// cannot read, for frames that lead nowhere, for sizes that are no numbers > 0.
SdfContent read_sdf_file(const std::filesystem::path& file, ModelPaths& paths,
                         const std::optional<std::string>& text = {});

}  // namespace spawnfield
