#pragma once

#include <spawnfield/export.h>
#include <spawnfield/frames.h>
#include <spawnfield/robot.h>

#include <filesystem>
#include <span>
#include <string>
#include <vector>

/// These functions write robots at their start poses as files that simulators load. They return the text or bytes of
/// the file, and the same robots and options always give the same bytes. Numbers read back to the same double.
namespace spawnfield {

/// A robot to put into a world: m and rad, REP-103. The functions convert it to the frame and the units of their
/// target.
struct RobotStart {
    std::string name;        ///< the name in the simulator; unique
    std::string name_space;  ///< namespace of its ROS topics and nodes
    Vec3 position = Vec3::Zero();
    Rpy rpy = {};
    std::string model = {};  ///< ROS, SDF: file or URI of its model; empty: that of the function's options
};

/// Returns one name for each robot: `{i}` in the pattern becomes the robot's number, beginning with 1; `{i:03}` becomes
/// the same with leading zeros, at least three digits. `option` is the name of the pattern in messages. Throws
/// ArgumentError if braces contain anything else, if more than 9 digits are wanted, or if several robots get the same
/// name.
SPAWNFIELD_API std::vector<std::string> numbered_names(const std::string& option, const std::string& pattern,
                                                       std::size_t count);

/// Throws ArgumentError if two names are the same, or if one is empty or has a control character.
SPAWNFIELD_API void check_names(const std::string& option, std::span<const std::string> names);

/// Throws ArgumentError unless each name is valid in ROS: segments of letters, digits and _, separated by /. In ROS 1,
/// the first character must be a letter. In ROS 2, a segment must not begin with a digit or contain two adjacent _.
SPAWNFIELD_API void check_ros_names(const std::string& option, std::span<const std::string> names, int ros);

/// Throws ArgumentError unless each name is valid for a model in SDF: letters, digits and _ - . / +, but not __ at both
/// ends.
SPAWNFIELD_API void check_model_names(const std::string& option, std::span<const std::string> names);

/// The file or topic from which ROS spawns the robots.
struct LaunchOptions {
    /// A URDF, or an SDF file if it ends in .sdf. In XML launch files it may contain $(find …) and $(find-pkg-share
    /// …). If it is empty, `topic` is used.
    std::string file = {};
    /// The topic (ROS 2) or parameter (ROS 1) with the robot's description, in the robot's namespace.
    std::string topic = {};
    std::string world = {};                  ///< ROS 2: name of Gazebo's world; empty: the first world that is running
    std::vector<JointPosition> joints = {};  ///< ROS 1: positions of joints (spawn_model -J)
};

/// Returns a launch file for roslaunch (ROS 1, gazebo_ros spawn_model) with a <group ns> for each robot. The text of a
/// URDF becomes the group's parameter robot_description. Throws ArgumentError for a .xacro, and if there is neither a
/// file nor a topic.
SPAWNFIELD_API std::string ros1_launch(std::span<const RobotStart> robots, const LaunchOptions& options);

/// Return a launch file for ros2 launch (ros_gz_sim create), in Python or XML, with a node in its namespace for each
/// robot. Throw as ros1_launch does. In Python, a file name with $(…) is an error too.
SPAWNFIELD_API std::string ros2_launch_py(std::span<const RobotStart> robots, const LaunchOptions& options);
SPAWNFIELD_API std::string ros2_launch_xml(std::span<const RobotStart> robots, const LaunchOptions& options);

/// The settings in a model's SDF file that change where simulators put the model.
struct ModelPlacement {
    /// Its placement_frame: <include> puts this frame at the given pose instead of the model's own frame.
    std::string frame = {};
    bool has_pose = false;  ///< it has a <pose> that is not 0, which gazebo_ros (ROS 1) adds to the given pose
};

/// Returns the placement of an SDF file or of a model's folder, and a default ModelPlacement for any other file. Throws
/// FileError.
SPAWNFIELD_API ModelPlacement model_placement(const std::filesystem::path& file);

struct SdfWorldOptions {
    std::string uri = {};  ///< URI of the robot's model: model://husky, or a file; SDF or URDF
    /// Name of a new world (default "spawns"). With `world_text`: name of the world to use, if the file has
    /// several.
    std::string world_name = {};
    /// Text of an SDF file; the robots are added to its world; empty: a new world without anything else.
    std::string world_text = {};
    std::string world_file = "SDF";  ///< name of that file, for messages and for relative paths of its includes
    std::vector<std::filesystem::path> model_paths = {};  ///< more folders in which its included models are searched
};

/// Returns an SDF world with an <include> for each robot. In a given world, they come after all other children; a new
/// world is SDF 1.7. Throws FileError if the text is not an SDF file with a world, or if a child of the world has the
/// name of a robot. Throws ArgumentError without a URI.
SPAWNFIELD_API std::string sdf_world(std::span<const RobotStart> robots, const SdfWorldOptions& options);

struct KeyframeOptions {
    /// One key with all robots, for a model that contains them all; false: one key for each robot.
    bool together = false;
    std::vector<double> joints = {};  ///< qpos of the joints after the free joint, the same for each robot
};

/// Returns <key qpos> elements for MuJoCo, to add to a model with <include>. Each robot has a free joint: x y z and the
/// quaternion w x y z.
SPAWNFIELD_API std::string mujoco_keyframes(std::span<const RobotStart> robots, const KeyframeOptions& options);

/// Returns a model for MuJoCo with a body and a free joint for each robot, and the key "spawns" of their poses. The
/// geoms are the robots' collision shapes; a hull is a mesh in the file itself. MuJoCo computes the masses from them.
/// `kind_of` has the index of each robot in `kinds`. To add a world, put both into a file with <include>. Throws
/// ArgumentError if robots and kind_of differ in size.
SPAWNFIELD_API std::string mujoco_bodies(std::span<const RobotStart> robots, std::span<const Robot> kinds,
                                         std::span<const std::size_t> kind_of);

enum class QuaternionOrder { Wxyz, Xyzw };

/// Returns root poses for Isaac Lab: a .npy file of float64, N x 7, with x y z and the quaternion. Its order is w x y z
/// up to Isaac Lab 2, and x y z w since Isaac Lab 3.
SPAWNFIELD_API std::string root_poses_npy(std::span<const RobotStart> robots, QuaternionOrder order);

/// A grid of tiles over a world, like the sub-terrains of Isaac Lab: rows along x, columns along y.
struct TileGrid {
    int rows = 1, cols = 1;  ///< 1 .. 10000
    Bounds bounds = {};      ///< of all tiles together; a point outside belongs to the nearest tile
};

/// Terrain patches and origins for Isaac Lab: .npy files of float32, rows x cols x patches_per_tile x 3, and rows x
/// cols x 3.
struct TerrainPatches {
    std::string flat_patches, terrain_origins;
    std::size_t patches_per_tile = 0;
};

/// Returns the points as patches, for each tile in their order. All tiles get as many patches as the fullest one: a
/// tile with fewer points repeats them from the first. The origin of a tile is its first patch. Throws ArgumentError if
/// a tile has no point. But if there are no points at all, there are no patches, and the origins are NaN.
SPAWNFIELD_API TerrainPatches terrain_patches(std::span<const Vec3> points, const TileGrid& grid);

/// Returns JSON with CARLA's own transforms (Python API), "location" and "rotation" of each robot: left-handed, m and
/// degrees.
SPAWNFIELD_API std::string carla_json(std::span<const RobotStart> robots, const std::string& blueprint);

/// Returns an objects.json for CARLA's ROS bridge (carla_spawn_objects). Its spawn_points are in ROS's frame, with
/// angles in degrees; the bridge converts them to CARLA's frame.
SPAWNFIELD_API std::string carla_objects_json(std::span<const RobotStart> robots, const std::string& blueprint);

/// Returns name,x,y,z,qx,qy,qz,qw of each robot in one of Unity's frames.
SPAWNFIELD_API std::string unity_csv(std::span<const RobotStart> robots, Frame frame);

/// Returns Name,X,Y,Z,Roll,Pitch,Yaw of each robot, cm and degrees: a data table for Unreal, whose first column
/// contains the names of the rows.
SPAWNFIELD_API std::string unreal_csv(std::span<const RobotStart> robots);

}  // namespace spawnfield
