#pragma once

#include <filesystem>

namespace spawnfield {

/// Return metres per unit of a 3MF or AMF file, which assimp 5.2 does not apply: the attribute `unit` of the root
/// element, or millimetres if it is missing. Throw FileError for a unit that the format does not have, and if the model
/// in a 3MF file cannot be found. Source: 3MF Consortium, 3MF Core Specification 1.3, 2.1 (3D payload relationship) and
/// 3.4 (model); ISO/ASTM 52915 (AMF).
double metres_per_unit_of_3mf(const std::filesystem::path& file);
double metres_per_unit_of_amf(const std::filesystem::path& file);

}  // namespace spawnfield
