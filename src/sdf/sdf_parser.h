#pragma once

#include "model/collision_geometry.h"
#include "model/model_paths.h"

#include <spawnfield/error.h>

#include <sdf/sdf.hh>

#include <memory>
#include <mutex>
#include <optional>

namespace spawnfield {

/// Prepares libsdformat while this object exists, and restores its settings at the end. libsdformat finds files through
/// a global callback (the only one that nested includes use) and prints messages itself; so does the URDF parser that
/// it tries for text that it does not know. Only one object exists at a time; others wait.
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

/// Does the same as root.Load(file, config), or with `text` the same as root.LoadSdfString(*text, config). Each of
/// these reads all files that describe the elements of SDF (0.02 s). This reads them only once, as libsdformat itself
/// does for <include>.
sdf::Errors load(sdf::Root& root, const std::filesystem::path& file, const std::optional<std::string>& text,
                 const sdf::ParserConfig& config);

/// How an error of libsdformat is treated here.
enum class SdfErrorKind {
    Frames,     ///< a frame is wrong, so poses would be wrong or missing
    Unknown,    ///< an element that is not part of SDF; it is ignored
    Duplicate,  ///< a second element with the same name, which libsdformat ignores
    Harmless,   ///< about inertia or old elements; collisions do not change
    Repeated,   ///< already reported by another message
    Other
};
SdfErrorKind kind_of(const sdf::Error& error);

/// Calls read() and turns exceptions of libsdformat (mostly about numbers in attributes) into FileError.
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
        throw FileError(
            file.string(),
            std::string("cannot be read as SDF: a number in it, or in a file that it includes, is malformed (") +
                error.what() + ")");
    }
}

/// Returns the absolute path of the file. libsdformat would take a relative "model.sdf" or "world.sdf" for the file of
/// that name in its own folder, which describes the element <model>.
std::string path_for_libsdformat(const std::filesystem::path& file);

/// Returns the message of an error with its file, line and element, as far as they are known.
std::string text_of_error(const sdf::Error& error, const std::string& file);

Vec3 vector_of(const ignition::math::Vector3d& v);
Pose pose_of(const ignition::math::Pose3d& pose);

/// Returns whether nothing collides with a collision because of its <surface>. Triggers and decoration are made this
/// way.
bool touches_nothing(const sdf::Collision& collision);

/// Returns whether a <geometry> has no shape, or has <empty/>.
bool is_empty(const sdf::Geometry& geometry);

/// The place of a collision in its file, for messages.
struct SdfPlace {
    std::filesystem::path file;
    std::string name;  ///< scoped name of the collision
    std::optional<int> line;
};

/// Reads a <geometry>. Throws FileError if it has more than one shape, or a size that is not > 0 or is more than 1000
/// km.
CollisionGeometry geometry_of(const sdf::Geometry& geometry, const SdfPlace& place);

}  // namespace spawnfield
