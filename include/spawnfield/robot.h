#pragma once

#include <spawnfield/export.h>
#include <spawnfield/joints.h>
#include <spawnfield/shape.h>

#include <filesystem>
#include <initializer_list>
#include <optional>
#include <string>
#include <vector>

namespace spawnfield {

/// One convex part of a robot, in the robot's frame.
struct RobotPart {
    Shape shape;
    std::vector<Vec3> hull_vertices;             ///< only for a Hull: corners in the robot's frame
    std::vector<std::array<int, 3>> hull_faces;  ///< only for a Hull: triangles, counterclockwise seen from outside
    std::string name;                            ///< the link it belongs to, or its name in robot.yaml; may be empty

    SPAWNFIELD_API Vec3 centre() const;  ///< a point inside the part, in the robot's frame
    SPAWNFIELD_API Bounds bounds() const;
};

/// The convex hulls that replace a mesh collision of a robot. Their union contains the whole mesh.
struct MeshFit {
    std::string name;                   ///< name of the robot's parts that replace the mesh
    std::string file;                   ///< name of the mesh file, without folders
    std::size_t parts = 1;              ///< number of convex hulls; they do not overlap
    double volume = 0;                  ///< of all hulls together, m3
    std::optional<double> mesh_volume;  ///< m3; known only if the mesh's pieces are watertight and lie apart

    /// Returns how much larger the hulls are than the mesh, as a share of its volume: 0.1 is 10 % more.
    std::optional<double> growth() const
    {
        return mesh_volume ? std::optional(volume / *mesh_volume - 1) : std::nullopt;
    }
};

/// How a robot moves on the ground. ReachGraph says which ways each of them has.
enum class Drive : std::uint8_t {
    Differential,  ///< straight ahead and back, and it turns on the spot
    Omni,          ///< also to the sides
    Legged,        ///< as Omni; it climbs steps of a height that its owner must say
    Car            ///< straight ahead and back, and in curves of a smallest radius; it cannot turn on the spot
};

/// The names of the drives in files and options, in their order.
inline constexpr std::initializer_list<const char*> drive_names{"differential", "omni", "legged", "car"};
SPAWNFIELD_API const char* name_of(Drive drive);
/// Throws ArgumentError for another name.
SPAWNFIELD_API Drive drive_called(const std::string& name);

/// What a robot's file says about how it drives.
struct RobotDrive {
    std::optional<Drive> kind = {};
    std::optional<double> max_step = {};        ///< m, >= 0; see ReachOptions
    std::optional<double> turning_radius = {};  ///< m, > 0; only for a car
    std::optional<double> wheel_radius = {};    ///< m, > 0; of its smallest wheel
};

/// A rigid body: the union of convex parts, in its own frame. The poses that commands read and write are poses of this
/// frame.
struct Robot {
    std::string name;
    std::vector<RobotPart> parts;  ///< at least one
    std::vector<Vec3> contacts;    ///< where wheels or feet touch the ground; may be empty
    std::vector<std::string> notices;
    std::vector<MeshFit> meshes = {};        ///< one for each mesh collision
    std::vector<JointPosition> joints = {};  ///< the RobotOptions::joints with which it was read
    int mesh_parts = 1;                      ///< the RobotOptions::mesh_parts with which it was read
    /// The centre of mass in the robot's frame, m: that of robot.yaml, or of all links of a URDF or SDF file that have
    /// an <inertial>. Empty: the file says nothing about it.
    std::optional<Vec3> mass_center = {};
    /// From the keys of robot.yaml. For a URDF or SDF file, only the wheel radius: the smallest radius of all cylinders
    /// and spheres of links that can turn without limits about a horizontal axis; for cylinders, it must be their own.
    RobotDrive drive = {};

    SPAWNFIELD_API Bounds bounds() const;
};

struct RobotOptions {
    /// Folders that contain models or ROS packages; see SceneOptions::model_paths.
    std::vector<std::filesystem::path> model_paths = {};
    /// Positions of joints of a URDF or SDF model. All other joints are at 0, or follow the joint that they mimic.
    std::vector<JointPosition> joints = {};
    int mesh_parts = 1;     ///< largest number of convex parts for each mesh collision, 1 .. 64; 1: its convex hull
    bool any_mesh = false;  ///< see SceneOptions::any_mesh
};

/// Reads robot.yaml (format spawnfield-robot/1), a .urdf, an SDF model (.sdf, or the folder with its model.config), or
/// `box:LX,LY,LZ[@x,y,z]`.
///
/// The robot of a URDF or SDF file is the union of all links' <collision>, in the frame of the root link or of the
/// model; <visual> is never read. A mesh becomes its convex hull (Barber, Dobkin, Huhdanpaa, The Quickhull algorithm,
/// 1996; libqhull). With mesh_parts > 1, planes cut the mesh first, and each part becomes a hull; their union contains
/// the whole mesh. Throws FileError for files. Throws ArgumentError for a bad `box:`, for mesh_parts out of range, and
/// for joints that are not in the file, cannot move or have limits that exclude the value.
SPAWNFIELD_API Robot load_robot(const std::string& robot, const RobotOptions& options = {});

/// The points at which the robot touches the ground, in its own frame. `given` is true if the robot's file has contacts
/// that span an area. Otherwise the points are those that JudgeOptions::max_slope uses: the corners of the convex hull,
/// seen from above, of everything within 2 cm of the robot's lowest point.
struct RobotContacts {
    std::vector<Vec3> points;
    bool given = false;
};
SPAWNFIELD_API RobotContacts robot_contacts(const Robot& robot);

/// Returns Robot::mass_center. If that is empty, returns the centroid of the volume of the robot's parts; volume in
/// which parts overlap counts for each of them.
SPAWNFIELD_API Vec3 mass_center_of(const Robot& robot);

}  // namespace spawnfield
