#pragma once

#include "scene/mesh.h"

namespace spawnfield {

using Names = std::vector<std::string>;

/// The first of the rules that matches the name, else `fallback`.
Label label_by_name(const std::string& name, const std::vector<LabelRule>& rules, Label fallback);

/// The same rules for the faces of a mesh: by node or material, whichever matches.
std::vector<FaceRule> face_rules(const std::vector<LabelRule>& rules);

bool matches_one(const std::string& pattern, const Names& names);

/// Adds those that are not there yet.
void add_names(const Names& more, Names& names);

/// A rule that matches nothing is most often a slip of the pen: told, with names that are there.
void tell_idle_rules(const std::filesystem::path& file, const std::vector<LabelRule>& rules, const Names& names,
                     Scene& scene);

/// Names of nodes and materials, each once.
Names names_of(std::span<const FaceGroup> groups);

/// How to label a scene in which everything is terrain: by names that look like ground, as options to be pasted, and
/// by slope.
std::string labelling_advice(const Scene& scene);

/// The first few of the names, with commas.
std::string first_of(const Names& names, std::size_t most);

}  // namespace spawnfield
