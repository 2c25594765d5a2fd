#pragma once

#include "this_build.h"
#include "catch.h"
#include "program.h"

#include <set>

inline const std::string training_scene = "'" + source_folder() + "/maps/training/scene.yaml'";
inline const std::string husky_option = " --robot '" + source_folder() + "/maps/robots/husky.yaml' ";

/// Returns the names of the entries of a folder.
inline std::set<std::string> names_in(const std::filesystem::path& folder)
{
    std::set<std::string> out;
    for (const auto& entry : std::filesystem::directory_iterator(folder)) out.insert(entry.path().filename().string());
    return out;
}

/// A folder with a copy of the baked training arena in `map`. The program runs in this folder.
class Arena : public TempFolder {
public:
    Arena() { std::filesystem::copy(baked() / "map", *this / "map"); }

    ProgramRun operator()(const std::string& arguments) const { return run_program(*this, arguments); }

    std::set<std::string> names() const { return names_in(path()); }

private:
    static const TempFolder& baked()
    {
        static const TempFolder folder;
        static const ProgramRun run = run_program(folder, "bake " + training_scene + " -o map --resolution 0.2");
        REQUIRE(run.status == 0);
        return folder;
    }
};
