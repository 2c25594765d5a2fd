#pragma once

#include "model/collision_geometry.h"
#include "model/model_paths.h"

#include <spawnfield/error.h>

#include <sdf/sdf.hh>

#include <memory>
#include <mutex>
#include <optional>

namespace spawnfield {

/// libsdformat finds files through a global callback (nested includes ask that one alone) and prints on its own, as
/// does the URDF parser that it tries on what it does not understand: all of it is held while this lives. One at a
/// time.
class SdfSession {
public:
    SdfSession(ModelPaths& paths, const std::filesystem::path& folder);
    SdfSession(const SdfSession&) = delete;
    SdfSession& operator=(const SdfSession&) = delete;
    ~SdfSession();

    const sdf::ParserConfig& config() const { return config_; }

private:
    std::lock_guard<std::mutex> lock_;
    int log_level_;
    sdf::ParserConfig config_;
};

/// What an error of libsdformat means here.
enum class SdfErrorKind {
    Frames,     ///< poses are wrong, or lost, where frames are not understood
    Unknown,    ///< an element that SDF does not know, and nobody reads
    Duplicate,  ///< a second thing of a name, which libsdformat leaves out
    Harmless,   ///< about mass or age, not about where collisions are
    Repeated,   ///< of what is told in another way
    Other
};
SdfErrorKind kind_of(const sdf::Error& error);

/// What libsdformat itself throws (of numbers in attributes, mostly) becomes a FileError.
template <class Read>
auto without_foreign_exceptions(const std::filesystem::path& file, const Read& read)
{
    try {
        return read();
    } catch (const FileError&) {
        throw;
    } catch (const ArgumentError&) {
        throw;
    } catch (const std::bad_alloc&) {
        throw;
    } catch (const std::exception& error) {
        throw FileError(file.string(),
                        std::string("cannot be read as SDF: a number in it, or in what it includes, is none (") +
                            error.what() + ")");
    }
}

/// A relative "model.sdf" or "world.sdf" it would take for the file of that name in its own folder, the description of
/// <model>.
std::string path_for_libsdformat(const std::filesystem::path& file);

/// File, line, element and words of an error, without what it has not.
std::string words_of(const sdf::Error& error, const std::string& file);

Vec3 vector_of(const ignition::math::Vector3d& v);
Pose pose_of(const ignition::math::Pose3d& pose);

/// What nobody collides with, by its <surface>: volumes for triggers and decoration.
bool touches_nothing(const sdf::Collision& collision);

/// <geometry> without a shape, or with <empty/>.
bool is_empty(const sdf::Geometry& geometry);

/// Where a collision stands, for complaints.
struct SdfPlace {
    std::filesystem::path file;
    std::string name;  ///< scoped
    std::optional<int> line;
};

/// Throws FileError for more than one shape, for sizes that are no numbers > 0 or beyond 1000 km.
CollisionGeometry geometry_of(const sdf::Geometry& geometry, const SdfPlace& place);

}  // namespace spawnfield
