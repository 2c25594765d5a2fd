#include "robot_args.h"

#include "common_args.h"
#include "numbers.h"

namespace spawnfield::cli {
namespace {

/// Reads "name=value,name=value". A name may contain "="; the last one separates. Throws ArgumentError.
void parse_joints(const std::string& text, std::vector<JointPosition>& out)
{
    for (std::size_t start = 0; start <= text.size();) {
        const std::size_t comma = std::min(text.find(',', start), text.size());
        const std::string one = text.substr(start, comma - start);
        const std::size_t equals = one.rfind('=');
        if (equals == std::string::npos || equals == 0)
            throw ArgumentError("--joints: \"" + one + "\" is not a joint; write name=value[,name=value…] in rad or m");
        out.push_back(
            {one.substr(0, equals), parse_numbers("--joints: " + one.substr(0, equals), one.substr(equals + 1)).at(0)});
        start = comma + 1;
    }
}

}  // namespace

void add_robot_options(CLI::App& command, RobotArgs& args)
{
    command
        .add_option("--joints", args.joints,
                    "name=value,…: positions of joints of a URDF or SDF model, rad or m (default 0; repeatable)")
        ->allow_extra_args(false);
    command
        .add_option(
            "--mesh-parts", args.mesh_parts,
            "Split each mesh collision of the robot into at most this many convex parts (default 1: its convex hull)")
        ->check(CLI::Range(1, 64));
}

RobotOptions robot_options(const RobotArgs& args)
{
    RobotOptions options;
    options.model_paths.assign(args.model_paths.begin(), args.model_paths.end());
    for (const std::string& joints : args.joints) parse_joints(joints, options.joints);
    options.mesh_parts = args.mesh_parts;
    options.any_mesh = args.any_mesh;
    return options;
}

}  // namespace spawnfield::cli
