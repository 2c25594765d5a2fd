#pragma once

#include <spawnfield/shape.h>

#include <filesystem>
#include <vector>

namespace spawnfield {

/// One convex part of a robot, in the robot's frame.
struct RobotPart {
    Shape shape;
    std::vector<Vec3> hull_vertices;               ///< Hull only: corners in the robot's frame
    std::vector<std::array<int, 3>> hull_faces;    ///< Hull only: triangles, counterclockwise from outside

    Vec3 centre() const;  ///< a point inside, robot frame
    Bounds bounds() const;
};

/// A rigid body: the union of convex parts, in its own frame, whose origin is the pose that commands take and give.
struct Robot {
    std::string name;
    std::vector<RobotPart> parts;   ///< at least one
    std::vector<Vec3> contacts;     ///< where wheels or feet touch the ground; may be empty
    std::vector<std::string> notices;

    Bounds bounds() const;
};

struct RobotOptions {
    std::vector<std::filesystem::path> package_paths = {};  ///< folders that hold ROS packages, for package:// URIs
};

/// Reads robot.yaml (format spawnfield-robot/1), a .urdf, or `box:LX,LY,LZ[@x,y,z]`.
///
/// URDF: the union of all links' <collision> at zero joint positions, in the root link's frame; <visual> is never read.
/// Meshes become their convex hulls (Barber, Dobkin, Huhdanpaa, The Quickhull algorithm, 1996; libqhull).
/// Throws FileError for files, ArgumentError for a bad `box:`.
Robot load_robot(const std::string& robot, const RobotOptions& options = {});

}  // namespace spawnfield
