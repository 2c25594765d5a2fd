#pragma once

#include "model/collision_geometry.h"
#include "model/model_paths.h"

#include <optional>

namespace spawnfield {

/// The collisions of an SDF file, and what was not read.
struct SdfContent {
    std::string name;  ///< name of the world, or of the model if there is no world
    std::vector<CollisionBody> bodies;
    std::vector<std::string> bare_models;  ///< models that have no collision
    std::size_t model_count = 0;           ///< number of outermost models
    std::size_t hollow = 0;                ///< number of collisions without a shape; they are ignored
    /// Number of collisions that touch nothing: a <collide_bitmask> of 0, or <collide_without_contact>. They are
    /// ignored.
    std::size_t untouchable = 0;
    std::vector<std::string> lost;  ///< messages about content that libsdformat ignores
    /// Messages of libsdformat that are not errors here.
    std::vector<std::string> complaints;
    /// If the file contains a model and no world: the model's own pose. The poses of `bodies` are then in the model's
    /// frame.
    Pose pose;
    /// A model whose pose does not depend on a frame, so that an <include> may replace its pose.
    bool is_plain_model = false;
};

/// Reads an SDF file by libsdformat, which resolves frames, relative_to, placement frames and nested includes. Poses
/// are in the frame of the world or of the model. If `text` is given, it is read instead of the file's text, of which
/// the caller has removed something. Throws FileError for a file that libsdformat cannot read, for frames that cannot
/// be resolved, and for sizes that are not numbers > 0.
SdfContent read_sdf_file(const std::filesystem::path& file, ModelPaths& paths,
                         const std::optional<std::string>& text = {});

}  // namespace spawnfield
