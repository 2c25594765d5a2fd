#pragma once

#include <spawnfield/export.h>
#include <spawnfield/joints.h>
#include <spawnfield/shape.h>

#include <filesystem>
#include <optional>
#include <vector>

namespace spawnfield {

/// One convex part of a robot, in the robot's frame.
struct RobotPart {
    Shape shape;
    std::vector<Vec3> hull_vertices;             ///< Hull only: corners in the robot's frame
    std::vector<std::array<int, 3>> hull_faces;  ///< Hull only: triangles, counterclockwise from outside
    std::string name;                            ///< the link it belongs to, or its name in robot.yaml; may be empty

    SPAWNFIELD_API Vec3 centre() const;  ///< a point inside, robot frame
    SPAWNFIELD_API Bounds bounds() const;
};

/// What stands for a mesh collision: one convex hull or several, which hold all of it.
struct MeshFit {
    std::string name;                   ///< of its parts
    std::string file;                   ///< without folders
    std::size_t parts = 1;              ///< convex hulls; they share no volume
    double volume = 0;                  ///< of these, m3
    std::optional<double> mesh_volume;  ///< m3; only of a mesh whose pieces are watertight and lie apart

    /// What is added to the mesh, as a share of it: 0.1 is 10 % more.
    std::optional<double> growth() const
    {
        return mesh_volume ? std::optional(volume / *mesh_volume - 1) : std::nullopt;
    }
};

/// A rigid body: the union of convex parts, in its own frame, whose origin is the pose that commands take and give.
struct Robot {
    std::string name;
    std::vector<RobotPart> parts;  ///< at least one
    std::vector<Vec3> contacts;    ///< where wheels or feet touch the ground; may be empty
    std::vector<std::string> notices;
    std::vector<MeshFit> meshes = {};        ///< one for each mesh collision
    std::vector<JointPosition> joints = {};  ///< RobotOptions::joints, as it was read
    int mesh_parts = 1;                      ///< RobotOptions::mesh_parts, as it was read

    SPAWNFIELD_API Bounds bounds() const;
};

struct RobotOptions {
    std::vector<std::filesystem::path> model_paths =
        {};  ///< folders that hold models or ROS packages, as SceneOptions::model_paths
    std::vector<JointPosition> joints =
        {};              ///< of a URDF or SDF model; all others stand at 0, or where those that they mimic tell
    int mesh_parts = 1;  ///< most convex parts that a mesh collision is split into, 1 .. 64; 1: its convex hull
};

/// Reads robot.yaml (format spawnfield-robot/1), a .urdf, an SDF model (.sdf, or the folder with its model.config), or
/// `box:LX,LY,LZ[@x,y,z]`.
///
/// URDF, SDF: the union of all links' <collision>, in the frame of the root link or of the model; <visual> is never
/// read. Meshes become their convex hulls (Barber, Dobkin, Huhdanpaa, The Quickhull algorithm, 1996; libqhull), or
/// several of them, of what planes cut them into: nothing of the mesh is outside of their union. Throws FileError for
/// files, ArgumentError for a bad `box:`, for joints that the file has not, that cannot be moved or whose limits do not
/// hold the value, and for mesh_parts out of range.
SPAWNFIELD_API Robot load_robot(const std::string& robot, const RobotOptions& options = {});

/// Where the robot touches the ground, in its own frame, and whether its file says so. Otherwise they are what
/// JudgeOptions::max_slope uses: the corners of what lies within 2 cm of its lowest point.
struct RobotContacts {
    std::vector<Vec3> points;
    bool given = false;
};
SPAWNFIELD_API RobotContacts robot_contacts(const Robot& robot);

}  // namespace spawnfield
