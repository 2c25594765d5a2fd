#include "base/foreign_file.h"

#include "base/text.h"

#include <spawnfield/error.h>
#include <spawnfield/input_file.h>

#include <array>
#include <cctype>

namespace spawnfield {
namespace {

namespace fs = std::filesystem;

struct ForeignKind {
    std::array<const char*, 4> extensions;
    const char* name;
    const char* as_scene;  ///< the remedy if the user gave it as a scene; FILE is replaced by its name
    const char* as_robot;  ///< the remedy if the user gave it as a robot
};

constexpr const char* give_urdf = "give the robot's URDF, or a robot.yaml (docs/robots.md)";

constexpr std::array kinds = {
    ForeignKind{{".usd", ".usda", ".usdc", ".usdz"},
                "a USD file",
                "turn it into GLB, for example in Blender (File > Import > Universal Scene Description, then File > "
                "Export > glTF 2.0)",
                give_urdf},
    ForeignKind{{".unity"},
                "a Unity scene",
                "export it to GLB in Unity (package com.unity.cloud.gltfast: File > Export Scene > glTF-Binary)",
                give_urdf},
    ForeignKind{{".umap", ".uasset"},
                "an Unreal Engine file",
                "export the level to GLB in Unreal (plugin glTF Exporter: File > Export All)",
                give_urdf},
    ForeignKind{{".blend"},
                "a Blender file",
                "export it to GLB in Blender (File > Export > glTF 2.0)",
                "export the robot as STL in Blender and name it in a robot.yaml (docs/robots.md)"},
    ForeignKind{{".xacro"},
                "a xacro file",
                "expand it first: xacro FILE > scene.urdf",
                "expand it first: xacro FILE > robot.urdf"},
    ForeignKind{{".rviz"},
                "an RViz configuration",
                "it has no geometry: give the world (.world, .sdf) or a mesh",
                "give the URDF that RViz shows"},
};

constexpr ForeignKind mjcf{
    {".mjcf"},
    "a MuJoCo model (MJCF)",
    "write its geoms as parts of a scene.yaml (docs/input-files.md), or give the meshes that it names",
    give_urdf};

/// Returns the name of the first element of an XML file, or "" if the first 64 KiB contain none.
std::string first_element(const fs::path& file)
{
    const std::string text = read_start(file, 1 << 16);
    for (std::size_t tag = text.find('<'); tag != std::string::npos; tag = text.find('<', tag + 1)) {
        if (text.compare(tag, 4, "<!--") == 0) tag = text.find("-->", tag);
        if (tag == std::string::npos) break;
        const std::size_t start = tag + 1;
        if (start < text.size() && std::isalpha(static_cast<unsigned char>(text[start])) != 0)
            return text.substr(start, text.find_first_of(" \t\r\n/>", start) - start);
    }
    return "";
}

const ForeignKind* kind_of(const fs::path& file)
{
    const std::string extension = lower_case(file.extension().string());
    for (const ForeignKind& kind : kinds)
        for (const char* const known : kind.extensions)
            if (known != nullptr && extension == known) return &kind;
    const bool is_mjcf = extension == ".mjcf" || (extension == ".xml" && first_element(file) == "mujoco");
    return is_mjcf ? &mjcf : nullptr;
}

void refuse(const fs::path& file, const char* const ForeignKind::*advice)
{
    const ForeignKind* const kind = kind_of(file);
    if (kind == nullptr) return;
    std::string words = kind->*advice;
    if (const std::size_t place = words.find("FILE"); place != std::string::npos)
        words.replace(place, 4, file.filename().string());
    throw FileError(file.string(), std::string("is ") + kind->name + ", which cannot be read here; " + words);
}

}  // namespace

void refuse_foreign_scene(const fs::path& file) { refuse(file, &ForeignKind::as_scene); }

void refuse_foreign_robot(const fs::path& file) { refuse(file, &ForeignKind::as_robot); }

}  // namespace spawnfield
