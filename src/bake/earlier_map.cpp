#include "bake/earlier_map.h"

#include "base/number.h"
#include "base/parallel.h"
#include "geometry/geometry_impl.h"
#include "geometry/part_globs.h"
#include "map/map_yaml.h"
#include "scene/label_rules.h"

#include <spawnfield/error.h>

#include <algorithm>
#include <numeric>
#include <unordered_map>

namespace spawnfield {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t none = std::size_t(-1);

/// Parts of a geometry that are marked.
using Marks = std::vector<bool>;

/// Returns marks for the parts that match one of the globs. `is_used` gets a mark for each glob that matches some part.
Marks named_parts(const Geometry& geometry, const std::vector<std::string>& globs, Marks& is_used)
{
    Marks out(geometry.parts().size());
    for (std::size_t g = 0; g < globs.size(); ++g)
        for (const std::size_t part : parts_that_match(geometry, globs[g])) out[part] = is_used[g] = true;
    return out;
}

/// Returns the index of each part in the other geometry, by name; none if it has no such part. Throws ArgumentError if
/// a name occurs twice.
std::vector<std::size_t> places_in(const Geometry& other, const Geometry& geometry)
{
    std::unordered_map<std::string_view, std::size_t> places;
    for (std::size_t part = 0; part < other.parts().size(); ++part)
        if (!places.emplace(other.parts()[part].name, part).second)
            throw ArgumentError("update_map", "two parts have the name \"" + other.parts()[part].name +
                                                  "\"; give each part a name of its own, or bake in full");
    std::vector<std::size_t> out;
    for (const Part& part : geometry.parts()) {
        const auto place = places.find(part.name);
        out.push_back(place == places.end() ? none : place->second);
    }
    return out;
}

/// Two states of a scene.
struct Comparison {
    Marks removed, added;            ///< in the old state and in the new one
    std::vector<std::string> wrong;  ///< names of parts that differ, but must not
};

/// Compares the parts of two states by their hashes. A part that has the same hash, but another place among the others,
/// counts as removed and added.
Comparison compare(const Geometry& old, const Geometry& now, const Marks& named_in_old, const Marks& named_in_now)
{
    const std::vector<std::size_t> place_in_old = places_in(old, now), place_in_now = places_in(now, old);
    const auto is_equal = [&](std::size_t part) {
        return place_in_old[part] != none && now.impl().part_hashes[part] == old.impl().part_hashes[place_in_old[part]];
    };
    Comparison out{Marks(old.parts().size(), true), Marks(now.parts().size(), true), {}};
    // Equal parts that no glob names must have kept their order. A named one is unchanged if it is between the same.
    std::vector<std::size_t> next_place(now.parts().size() + 1, old.parts().size());
    for (std::size_t part = now.parts().size(); part-- > 0;)
        next_place[part] = !named_in_now[part] && is_equal(part) ? place_in_old[part] : next_place[part + 1];
    std::size_t next_free = 0;  // in the old state, after the unchanged part before
    for (std::size_t part = 0; part < now.parts().size(); ++part) {
        const std::size_t place = place_in_old[part];
        const bool is_unchanged = is_equal(part) && place >= next_free &&
                                  (!named_in_now[part] || place < next_place[part + 1]);
        if (is_unchanged) {
            out.added[part] = out.removed[place] = false;
            next_free = place + 1;
        } else if (!named_in_now[part]) {
            out.wrong.push_back(now.parts()[part].name);
        }
    }
    for (std::size_t part = 0; part < old.parts().size(); ++part)
        if (place_in_now[part] == none && !named_in_old[part]) out.wrong.push_back(old.parts()[part].name);
    return out;
}

/// Appends boxes around the elements of the marked parts, one for each tile that has some. Reads all tiles.
void append_boxes(const Geometry& geometry, const Marks& marks, int threads, std::vector<ElementBox>& boxes)
{
    if (std::find(marks.begin(), marks.end(), true) == marks.end()) return;
    const Geometry::Impl& impl = geometry.impl();
    impl.expect_all();
    impl.for_each_tree([&](const Forest& forest, std::size_t tree) {
        std::vector<std::optional<ElementBox>> found(forest.trees[tree].boxes().size());
        parallel_for(found.size(), threads, {}, [&](std::size_t t) {
            const Tile tile = impl.open(forest, tree, t);
            const auto is_marked = [&](const auto& item) { return marks[item.part]; };
            if (std::none_of(tile.pieces.begin(), tile.pieces.end(), is_marked) &&
                std::none_of(tile.primitives.begin(), tile.primitives.end(), is_marked))
                return;
            for (std::uint32_t element = 0; element < tile.elements(); ++element) {
                if (!marks[tile.part(element)]) continue;
                const ElementBox box = tile.box(element);
                if (found[t])
                    extend(*found[t], box);
                else
                    found[t] = box;
            }
        });
        for (const auto& box : found)
            if (box) boxes.push_back(*box);
    });
}

std::string z_words(const ZRange& z)
{
    return z.is_unlimited() ? "no z limits" : "z limits " + number(z.low) + ":" + number(z.high) + " m";
}

/// Throws ArgumentError if the user chose an option that gives a map unlike the old one.
void check_options(const fs::path& folder, const Map& old, const Map& now, const BakeOptions& options)
{
    const auto refuse = [&](const std::string& had, const std::string& has, const std::string& give) {
        throw ArgumentError("update_map", folder.string() + " was baked with " + had + ", not with " + has + "; give " +
                                              give + " as for that bake, or bake in full (without --update)");
    };
    if (old.z_limits != now.z_limits) refuse(z_words(old.z_limits), z_words(now.z_limits), "--z or --bounds");
    const auto same_bounds = [&] { return old.bounds.min == now.bounds.min && old.bounds.max == now.bounds.max; };
    if (!options.bounds.is_empty() && !same_bounds())
        refuse("the bounds " + to_string(old.bounds), to_string(now.bounds), "--bounds");
    if (!same_bounds()) return;  // a changed part changed the bounds, and perhaps with them the resolution
    if (old.resolution != now.resolution)
        refuse("a resolution of " + number(old.resolution) + " m", number(now.resolution) + " m", "--resolution");
    if (old.occupancy_resolution != now.occupancy_resolution)
        refuse("an occupancy resolution of " + number(old.occupancy_resolution) + " m",
               number(now.occupancy_resolution) + " m", "--occupancy-resolution");
}

/// Throws ArgumentError for a glob that matches nothing in either state.
void check_globs(const Geometry& now, const std::vector<std::string>& globs, const Marks& is_used)
{
    if (globs.empty()) throw ArgumentError("update_map", "changed_parts is empty, needs the names of parts");
    for (std::size_t g = 0; g < globs.size(); ++g)
        if (!is_used[g])
            throw ArgumentError("update_map", no_part_matches(now, globs[g]) + "; the old map has no such part either");
}

}  // namespace

EarlierState earlier_state(const fs::path& folder, const fs::path& scene_file, const Map& now,
                           const std::vector<std::string>& globs, const BakeOptions& options)
{
    EarlierMap earlier;
    earlier.map = read_map(folder);
    const Map& old = earlier.map;
    Marks is_used(globs.size());
    const Marks named_in_old = named_parts(old.geometry, globs, is_used),
                named_in_now = named_parts(now.geometry, globs, is_used);
    check_globs(now.geometry, globs, is_used);
    check_options(folder, old, now, options);
    const bool has_hashes = old.geometry.impl().part_hashes.size() == old.geometry.parts().size();
    if (!has_hashes || old.format_version != map_format_version)
        return {std::nullopt, "the old map has format " + std::to_string(old.format_version) +
                                  ", and parts of format " + std::to_string(map_format_version) +
                                  " only can be compared"};
    if (!is_of_this_program(folder)) return {std::nullopt, "another version of the program baked the old map"};
    const Comparison parts = compare(old.geometry, now.geometry, named_in_old, named_in_now);
    if (!parts.wrong.empty())
        throw FileError(scene_file.string(),
                        (parts.wrong.size() == 1 ? "a part differs from " : "parts differ from ") + folder.string() +
                            ", and --update does not name " + (parts.wrong.size() == 1 ? "it: " : "them: ") +
                            first_of(parts.wrong, 8) +
                            "; name all changed parts (--update '*' finds them), or bake in full (without --update)");
    if (old.bounds.min != now.bounds.min || old.bounds.max != now.bounds.max)
        return {std::nullopt, "the bounds changed from " + to_string(old.bounds) + " to " + to_string(now.bounds)};
    if (old.geometry.impl().has_filled_meshes != now.geometry.impl().has_filled_meshes)
        return {std::nullopt, "the scene has filled meshes only before or only after the change"};
    append_boxes(old.geometry, parts.removed, options.threads, earlier.boxes);
    append_boxes(now.geometry, parts.added, options.threads, earlier.boxes);
    earlier.terrain = read_terrain(old);
    earlier.heightmap_z = read_map_yaml(folder).heightmap_z;
    return {std::move(earlier), ""};
}

void copy_heightmap(const Map& from, const fs::path& to)
{
    check_listed(from.folder, "heightmap.png");
    std::error_code error;
    fs::copy_file(from.folder / "heightmap.png", to, error);
    if (error) throw OutputError(to.string(), "cannot be written: " + error.message());
}

}  // namespace spawnfield
