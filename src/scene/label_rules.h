#pragma once

#include "scene/mesh.h"

namespace spawnfield {

using Names = std::vector<std::string>;

/// Returns the label of the first rule that matches the name, or `fallback`.
Label label_by_name(const std::string& name, const std::vector<LabelRule>& rules, Label fallback);

/// Returns the same rules for the faces of a mesh. A rule matches if the node or the material matches.
std::vector<FaceRule> face_rules(const std::vector<LabelRule>& rules);

/// Returns whether the pattern matches one of the names.
bool matches_one(const std::string& pattern, const Names& names);

/// Adds to `names` those of `more` that are not empty and not in it yet.
void add_names(const Names& more, Names& names);

/// Adds a notice for each rule that matches none of the names, because it is most often a typing error. The notice
/// lists some names.
void note_unused_rules(const std::filesystem::path& file, const std::vector<LabelRule>& rules, const Names& names,
                       Scene& scene);

/// Returns the names of nodes and materials, each once.
Names names_of(std::span<const FaceGroup> groups);

/// Returns advice for a scene in which everything is terrain: options that label by slope, and by the names that look
/// like ground. The user can copy them.
std::string labelling_advice(const Scene& scene);

/// Returns at most the first `most` names, separated by commas; then "…" if there are more.
std::string first_of(const Names& names, std::size_t most);

}  // namespace spawnfield
