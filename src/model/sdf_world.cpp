#include "model/sdf_world.h"

#include "base/number.h"
#include "model/sdf_includes.h"
#include "model/sdf_text.h"

#include <spawnfield/error.h>

#include <algorithm>
#include <cmath>
#include <sstream>

namespace spawnfield {
namespace {

namespace fs = std::filesystem;

/// Reads "x y z roll pitch yaw". Returns nothing if the pose is not six finite numbers, or has attributes, so that it
/// may depend on a frame.
std::optional<Pose> plain_pose(const Xml& pose)
{
    for (const tinyxml2::XMLAttribute* attribute = pose.FirstAttribute(); attribute != nullptr;
         attribute = attribute->Next())
        if (*attribute->Value() != '\0') return {};
    std::istringstream words(pose.GetText() != nullptr ? pose.GetText() : "");
    std::vector<double> values;
    for (std::string word; words >> word;) {
        double value = 0;
        if (!parse_number(word, value) || !std::isfinite(value)) return {};
        values.push_back(value);
    }
    if (values.size() != 6) return {};
    return Pose{{values[0], values[1], values[2]}, rotation_from_rpy(values[3], values[4], values[5])};
}

/// Returns whether the pose of an <include> depends on nothing else.
bool is_plain(const Xml& include)
{
    if (include.FirstAttribute() != nullptr) return false;
    bool plain = true;
    for_each_child(include, nullptr, [&](const Xml& child) {
        const std::string name = child.Name();
        plain = plain && (name == "uri" || name == "name" || name == "static" || name == "plugin" ||
                          (name == "pose" && plain_pose(child)));
    });
    return plain;
}

/// Returns whether something in the world may depend on the frame of an included model.
bool depends_on_frames(const Xml& world)
{
    bool found = world.FirstChildElement("frame") != nullptr || world.FirstChildElement("joint") != nullptr;
    for_each_element(world, [&](const Xml& element) {
        for (const char* const name : {"relative_to", "attached_to", "frame"}) {
            const char* const value = element.Attribute(name);
            found = found || (value != nullptr && *value != '\0');
        }
    });
    return found;
}

class WorldReader {
public:
    WorldReader(fs::path file, ModelPaths& paths, bool allow_missing)
        : file_(std::move(file)), paths_(paths), allow_missing_(allow_missing)
    {
    }

    SdfWorld read()
    {
        const auto document = read_sdf_xml(file_);
        missing_ = check_includes(file_, *document, paths_);
        if (!allow_missing_ && !missing_.empty()) refuse_missing(file_, missing_);
        for (const MissingIncludes::value_type& entry : missing_)
            out_.missing.push_back(text_of_missing(entry) + ": it is ignored");
        const Xml* const world = document->RootElement()->FirstChildElement("world");
        if (world == nullptr) {
            read_lone_model();
        } else {
            refuse_population(*world);
            note_state(*world);
            if (const Xml* const model = document->RootElement()->FirstChildElement("model"))
                out_.missing.push_back(file_.string() + ": " + line_of(*model) +
                                       "<model> is beside <world>: it is ignored; move it into <world>");
            for_each_child(*world, "actor", [&](const Xml&) { ++out_.actor_count; });
            for_each_child(*world, "road", [&](const Xml&) { ++out_.road_count; });
            const std::vector<const Xml*> includes = plain_includes(*world);
            append(read_sdf_file(file_, paths_, text_for_libsdformat(*document, *world, includes)));
            for (const Xml* const include : includes) append_include(*include);
        }
        return std::move(out_);
    }

private:
    void read_lone_model()
    {
        const SdfContent content = read_sdf_file(file_, paths_);
        if (content.is_plain_model) return append_placed(content, content.pose, content.name);
        // The pose depends on a placement frame or on relative_to. A world that includes the model makes libsdformat
        // resolve it.
        append(read_sdf_file(file_, paths_,
                             "<sdf version='1.9'><world name='" + content.name + "'><include><uri>" +
                                 fs::absolute(file_).string() + "</uri></include></world></sdf>"));
    }

    /// Returns the includes whose pose does not depend on frames, of models for which the same is true.
    std::vector<const Xml*> plain_includes(const Xml& world)
    {
        std::vector<const Xml*> out;
        if (depends_on_frames(world)) return out;
        for_each_child(world, "include", [&](const Xml& include) {
            if (!is_plain(include)) return;
            const fs::path file = included_file(text_of(include, "uri"), file_.parent_path(), paths_);
            if (!file.empty() && model_in(file).is_plain_model) out.push_back(&include);
        });
        return out;
    }

    const SdfContent& model_in(const fs::path& file)
    {
        const auto known = models_.find(file);
        if (known != models_.end()) return known->second;
        SdfContent& model = models_[file] = read_sdf_file(file, paths_);
        take_messages(model);
        return model;
    }

    /// Returns the text of the document without the given includes, without missing includes, and without elements that
    /// do not affect any pose.
    std::string text_for_libsdformat(const tinyxml2::XMLDocument& document, const Xml& world,
                                     const std::vector<const Xml*>& includes) const
    {
        std::set<const Xml*> removed(includes.begin(), includes.end());
        for_each_child(world, nullptr, [&](const Xml& child) {
            const std::string name = child.Name();
            const bool is_irrelevant = name == "actor" || name == "road" || name == "state" || name == "gui" ||
                                       name == "plugin" || name == "light";
            const bool is_missing = name == "include" && missing_.contains(text_of(child, "uri"));
            if (is_irrelevant || is_missing) removed.insert(&child);
        });
        return text_without(document, removed);
    }

    void append_include(const Xml& include)
    {
        const SdfContent& model = model_in(included_file(text_of(include, "uri"), file_.parent_path(), paths_));
        const Xml* const pose = include.FirstChildElement("pose");
        const std::string name = text_of(include, "name");
        append_placed(model, pose != nullptr ? *plain_pose(*pose) : model.pose, name.empty() ? model.name : name,
                      include.GetLineNum());
    }

    void append_placed(const SdfContent& model, const Pose& world_from_model, const std::string& name, int line = 0)
    {
        if (out_.name.empty()) out_.name = name;
        ++out_.model_count;
        if (!names_.insert(name).second) {
            out_.missing.push_back(file_.string() + ": line " + std::to_string(line) +
                                   ": <include> is a second model with the name \"" + name +
                                   "\": it is ignored, as by libsdformat; give it a <name> of its own");
            return;
        }
        if (model.bodies.empty()) out_.bare_models.push_back(name);
        for (CollisionBody body : model.bodies) {
            body.names[0] = name;
            body.pose = world_from_model * body.pose;
            out_.bodies.push_back(std::move(body));
        }
        count_ignored(model);
        if (line == 0) take_messages(model);
    }

    void append(SdfContent content)
    {
        out_.name = content.name;
        out_.model_count += content.model_count;
        for (CollisionBody& body : content.bodies) {
            names_.insert(body.names[0]);
            out_.bodies.push_back(std::move(body));
        }
        for (std::string& name : content.bare_models) out_.bare_models.push_back(std::move(name));
        count_ignored(content);
        take_messages(content);
    }

    void count_ignored(const SdfContent& content)
    {
        out_.hollow += content.hollow;
        out_.untouchable += content.untouchable;
    }

    /// Takes over the messages of the content.
    void take_messages(const SdfContent& content)
    {
        out_.notices.insert(out_.notices.end(), content.complaints.begin(), content.complaints.end());
        out_.missing.insert(out_.missing.end(), content.lost.begin(), content.lost.end());
    }

    void refuse_population(const Xml& world) const
    {
        const Xml* const population = world.FirstChildElement("population");
        if (population == nullptr) return;
        const char* const name = population->Attribute("name");
        throw FileError(file_.string(), line_of(*population) + "<population> \"" + (name != nullptr ? name : "") +
                                            "\" cannot be read here, because Gazebo places its models anew at each "
                                            "start; write them as <include>s, or remove it");
    }

    /// Adds a notice if <state> would move models: Gazebo classic starts from it, libsdformat and new Gazebo do not.
    void note_state(const Xml& world)
    {
        const Xml* const state = world.FirstChildElement("state");
        if (state == nullptr) return;
        std::string first;
        std::size_t count = 0;
        for_each_child(*state, "model", [&](const Xml& saved) {
            const Xml* const there = saved.FirstChildElement("pose");
            const std::optional<Pose> then = there != nullptr ? plain_pose(*there) : std::nullopt;
            const std::string name = saved.Attribute("name") != nullptr ? saved.Attribute("name") : "";
            for_each_child(world, "model", [&](const Xml& model) {
                const Xml* const here = model.FirstChildElement("pose");
                const std::optional<Pose> now = here != nullptr ? plain_pose(*here) : Pose{};
                const bool is_same = model.Attribute("name") == nullptr || model.Attribute("name") != name || !then ||
                                     !now;
                if (is_same || (then->position - now->position).norm() < 1e-3) return;
                if (count++ == 0)
                    first = "\"" + name + "\" would be at " + number(then->position.x()) + ", " +
                            number(then->position.y()) + ", " + number(then->position.z());
            });
        });
        if (count > 0)
            out_.notices.push_back(
                file_.string() + ": " + line_of(*state) + "<state> is ignored, as by new Gazebo; in it " + first +
                (count > 1 ? ", and " + std::to_string(count - 1) + " more models would be elsewhere" : "") +
                "; Gazebo classic starts from it");
    }

    const fs::path file_;
    ModelPaths& paths_;
    const bool allow_missing_;
    MissingIncludes missing_;
    SdfWorld out_;
    std::set<std::string> names_;
    std::map<fs::path, SdfContent> models_;
};

}  // namespace

SdfWorld read_sdf_world(const fs::path& file, ModelPaths& paths, bool allow_missing)
{
    return WorldReader(file, paths, allow_missing).read();
}

}  // namespace spawnfield
