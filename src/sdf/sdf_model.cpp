#include "model/sdf_model.h"

#include "model/sdf_module.h"
#include "sdf/sdf_parser.h"

#include <spawnfield/error.h>

#include <tuple>

namespace spawnfield {
namespace {

namespace fs = std::filesystem;

/// Returns the side lengths of the largest plane, box or heightmap among the link's visuals, as x and y; 0 if there is
/// none.
Vec3 drawn_size(const sdf::Link& link)
{
    constexpr double largest = 1e6;  // m, the same limit as for collisions
    Vec3 size = Vec3::Zero();
    for (std::uint64_t v = 0; v < link.VisualCount(); ++v) {
        const sdf::Geometry* const geometry = link.VisualByIndex(v)->Geom();
        if (geometry == nullptr) continue;
        double x = 0, y = 0;
        if (geometry->PlaneShape() != nullptr)
            std::tie(x, y) = std::pair(geometry->PlaneShape()->Size().X(), geometry->PlaneShape()->Size().Y());
        if (geometry->BoxShape() != nullptr)
            std::tie(x, y) = std::pair(geometry->BoxShape()->Size().X(), geometry->BoxShape()->Size().Y());
        if (geometry->HeightmapShape() != nullptr)
            std::tie(x, y) = std::pair(geometry->HeightmapShape()->Size().X(), geometry->HeightmapShape()->Size().Y());
        const bool is_usable = x > 0 && y > 0 && x <= largest && y <= largest;
        if (is_usable && x * y > size.x() * size.y()) size = Vec3(x, y, 0);
    }
    return size;
}

class SdfReader {
public:
    SdfReader(const fs::path& file, ModelPaths& paths) : file_(file), session_(paths, file.parent_path()) {}

    SdfContent read(const std::optional<std::string>& text)
    {
        sdf::Root root;
        const sdf::Errors errors = load(root, file_, text, session_.config());
        if (root.WorldCount() == 0 && root.Model() == nullptr) {
            if (root.Light() != nullptr)
                return {};  // for example Gazebo's "sun"; libsdformat resolves an <include> of it
            if (!errors.empty()) throw FileError(text_of_error(errors[0], file_.string()), "cannot be read as SDF");
            throw FileError(file_.string(), "has no <world> and no <model>, needs one of them");
        }
        if (root.WorldCount() > 1)
            throw FileError(file_.string(), "has " + std::to_string(root.WorldCount()) +
                                                " worlds, needs one: a simulator runs one at a time");
        sort(errors);
        if (root.WorldCount() == 1)
            add_world(*root.WorldByIndex(0));
        else
            add_lone_model(*root.Model());
        return std::move(content_);
    }

private:
    /// Throws FileError for errors that make poses wrong, and takes all others into the content's messages.
    void sort(const sdf::Errors& errors)
    {
        constexpr std::size_t most_unknown = 10;
        std::size_t inertias = 0, unknown = 0;
        for (const sdf::Error& error : errors) {
            const SdfErrorKind kind = kind_of(error);
            const std::string words = text_of_error(error, file_.string());
            if (kind == SdfErrorKind::Frames) throw FileError(words, "a frame is wrong, so poses cannot be determined");
            if (error.Code() == sdf::ErrorCode::LINK_INERTIA_INVALID)
                ++inertias;
            else if (kind == SdfErrorKind::Duplicate)
                content_.lost.push_back(words);
            else if (kind == SdfErrorKind::Unknown && ++unknown > most_unknown)
                continue;
            else if (kind != SdfErrorKind::Repeated)
                content_.complaints.push_back(words);
        }
        if (unknown > most_unknown)
            content_.complaints.push_back(file_.string() + ": " + std::to_string(unknown - most_unknown) +
                                          " more elements that are not part of SDF");
        if (inertias > 0)
            content_.complaints.push_back(file_.string() + ": " + std::to_string(inertias) +
                                          (inertias == 1 ? " link has" : " links have") +
                                          " an invalid <inertia>: it is ignored here, but Gazebo may refuse it");
    }

    void add_world(const sdf::World& world)
    {
        content_.name = world.Name();
        content_.model_count = world.ModelCount();
        for (std::uint64_t m = 0; m < world.ModelCount(); ++m) {
            const sdf::Model& model = *world.ModelByIndex(m);
            names_ = {model.Name()};
            add_model(model, resolved(model.SemanticPose()));
        }
    }

    void add_lone_model(const sdf::Model& model)
    {
        content_.name = model.Name();
        content_.model_count = 1;
        content_.is_plain_model = model.PlacementFrameName().empty() && model.PoseRelativeTo().empty();
        content_.pose = pose_of(model.RawPose());
        names_ = {model.Name()};
        add_model(model, {});
    }

    /// Adds the bodies of a model. `pose` is the model's pose in the content's frame; the last of `names_` is the
    /// model's name.
    void add_model(const sdf::Model& model, const Pose& pose)
    {
        const std::size_t before = content_.bodies.size();
        for (std::uint64_t l = 0; l < model.LinkCount(); ++l) {
            const sdf::Link& link = *model.LinkByIndex(l);
            names_.push_back(link.Name());
            add_link(link, pose * resolved(link.SemanticPose()));
            names_.pop_back();
        }
        for (std::uint64_t m = 0; m < model.ModelCount(); ++m) {
            const sdf::Model& nested = *model.ModelByIndex(m);
            names_.push_back(nested.Name());
            add_model(nested, pose * resolved(nested.SemanticPose()));
            names_.pop_back();
        }
        if (content_.bodies.size() == before && names_.size() == 1) content_.bare_models.push_back(model.Name());
    }

    void add_link(const sdf::Link& link, const Pose& pose)
    {
        for (std::uint64_t c = 0; c < link.CollisionCount(); ++c) {
            const sdf::Collision& collision = *link.CollisionByIndex(c);
            if (touches_nothing(collision)) {
                ++content_.untouchable;
                continue;
            }
            if (collision.Geom() == nullptr || is_empty(*collision.Geom())) {
                ++content_.hollow;
                continue;
            }
            names_.push_back(collision.Name());
            content_.bodies.push_back({names_, pose * resolved(collision.SemanticPose()),
                                       geometry_of(*collision.Geom(), place_of(collision))});
            CollisionGeometry& geometry = content_.bodies.back().geometry;
            if (geometry.kind == CollisionGeometry::Kind::Plane) geometry.size = drawn_size(link);
            names_.pop_back();
        }
    }

    SdfPlace place_of(const sdf::Collision& collision) const
    {
        // The path of the included file that contains the element. For text in memory it is a name in angle brackets.
        const std::string from = collision.Element()->FilePath();
        return {from.empty() || from.front() == '<' ? file_ : fs::path(from), scoped_name({names_, {}, {}}),
                collision.Element()->LineNumber()};
    }

    Pose resolved(const sdf::SemanticPose& semantic) const
    {
        ignition::math::Pose3d pose;
        const sdf::Errors errors = semantic.Resolve(pose);
        if (!errors.empty())
            throw FileError(file_.string(), place() + ": its pose cannot be determined: " + errors[0].Message());
        if (!pose.IsFinite()) throw FileError(file_.string(), place() + ": its pose has numbers that are not finite");
        return pose_of(pose);
    }

    std::string place() const { return "\"" + scoped_name({names_, {}, {}}) + "\""; }

    const fs::path file_;
    const SdfSession session_;
    SdfContent content_;
    std::vector<std::string> names_;  ///< names from the outermost model to the element that is read now
};

}  // namespace

SdfContent sdf_module::read_file(const fs::path& file, ModelPaths& paths, const std::optional<std::string>& text)
{
    return without_foreign_exceptions(file, [&] { return SdfReader(file, paths).read(text); });
}

}  // namespace spawnfield
