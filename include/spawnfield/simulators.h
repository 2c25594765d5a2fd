#pragma once

#include <spawnfield/export.h>
#include <spawnfield/frames.h>
#include <spawnfield/robot.h>

#include <filesystem>
#include <span>
#include <string>
#include <vector>

/// Robots at their start poses as text or bytes of files that simulators load. Every function is pure: the same robots
/// and options give the same bytes. Numbers read back to the same double.
namespace spawnfield {

/// A robot to be put into a world. m and rad, REP-103; each writer turns it into its target's own frame and units.
struct RobotStart {
    std::string name;        ///< unique, as the simulator shows it
    std::string name_space;  ///< of its ROS topics and nodes
    Vec3 position = Vec3::Zero();
    Rpy rpy = {};
};

/// One name per robot: `{i}` in the pattern is the robot's number, from 1 on, `{i:03}` the same with zeros in front up
/// to three digits. `option` is what the messages call the pattern. Throws ArgumentError for braces that hold anything
/// else, more than 9 digits, or several robots of one name.
SPAWNFIELD_API std::vector<std::string> numbered_names(const std::string& option, const std::string& pattern,
                                                       std::size_t count);

/// Throws ArgumentError where two names are the same, or one is empty or has a control character.
SPAWNFIELD_API void check_names(const std::string& option, std::span<const std::string> names);

/// Throws ArgumentError unless each is a name for ROS, segments of letters, digits and _ with / between them: in ROS 1
/// the first character is a letter, in ROS 2 no segment begins with a digit and none has two _ after each other.
SPAWNFIELD_API void check_ros_names(const std::string& option, std::span<const std::string> names, int ros);

/// Throws ArgumentError unless each may be the name of a model in SDF: letters, digits and _ - . / +, not __ at both
/// ends.
SPAWNFIELD_API void check_model_names(const std::string& option, std::span<const std::string> names);

/// What ROS spawns each robot from.
struct LaunchOptions {
    std::string file =
        {};  ///< URDF, or SDF if it ends in .sdf; XML takes $(find …) and $(find-pkg-share …) in it. Or else
    std::string topic =
        {};  ///< ROS 2: topic, ROS 1: parameter, in the robot's namespace, that holds the robot's description
    std::string world = {};                  ///< ROS 2: name of Gazebo's world; empty: the first that runs
    std::vector<JointPosition> joints = {};  ///< ROS 1: where joints stand (spawn_model -J)
};

/// roslaunch (ROS 1, gazebo_ros spawn_model): a <group ns> for each robot. A URDF becomes robot_description of the
/// group. Throws ArgumentError for a .xacro, or neither file nor topic.
SPAWNFIELD_API std::string ros1_launch(std::span<const RobotStart> robots, const LaunchOptions& options);

/// ros2 launch, Python and XML (ros_gz_sim create), a node in the robot's namespace for each. Throws as ros1_launch;
/// Python knows no $(…).
SPAWNFIELD_API std::string ros2_launch_py(std::span<const RobotStart> robots, const LaunchOptions& options);
SPAWNFIELD_API std::string ros2_launch_xml(std::span<const RobotStart> robots, const LaunchOptions& options);

/// What simulators add to, or put in the place of, the pose that a robot is given: of the model in an SDF file.
struct ModelPlacement {
    std::string frame = {};  ///< its placement_frame: <include> puts this frame there, and not the model's own
    bool has_pose = false;   ///< it has a <pose> that is not 0: gazebo_ros (ROS 1) adds it
};

/// Of an SDF file or a model's folder; nothing for any other file. Throws FileError.
SPAWNFIELD_API ModelPlacement model_placement(const std::filesystem::path& file);

struct SdfWorldOptions {
    std::string uri = {};  ///< of the robot's model: model://husky, or a file; SDF or URDF
    std::string world_name =
        {};  ///< of a world made anew (default "spawns"); with `world_text`: which of its worlds, if many
    std::string world_text = {};     ///< an SDF file, whose world gets the robots; empty: a new world with nothing else
    std::string world_file = "SDF";  ///< its name, for messages, and for what its includes are relative to
    std::vector<std::filesystem::path> model_paths = {};  ///< where else models that it includes are looked for
};

/// An SDF world (1.7 if it is new) with an <include> for each robot, at the end of what is there.
/// Throws FileError where the text is no SDF with a world, or the world has a child of a robot's name, ArgumentError
/// without uri.
SPAWNFIELD_API std::string sdf_world(std::span<const RobotStart> robots, const SdfWorldOptions& options);

struct KeyframeOptions {
    bool together = false;            ///< one key for a model of all robots, not one for each of a model of one robot
    std::vector<double> joints = {};  ///< qpos of what follows the free joint, of each robot
};

/// MuJoCo: <key qpos> of free joints, x y z and the quaternion w x y z, to be included into a model by <include>.
SPAWNFIELD_API std::string mujoco_keyframes(std::span<const RobotStart> robots, const KeyframeOptions& options);

enum class QuaternionOrder { Wxyz, Xyzw };

/// Isaac Lab's root poses: .npy of float64, N x 7, x y z and the quaternion: w x y z up to Isaac Lab 2, x y z w from 3
/// on.
SPAWNFIELD_API std::string root_poses_npy(std::span<const RobotStart> robots, QuaternionOrder order);

/// A grid of tiles over a world, as Isaac Lab arranges its sub-terrains: rows along x, columns along y.
struct TileGrid {
    int rows = 1, cols = 1;  ///< 1 .. 10000
    Bounds bounds = {};      ///< of all tiles; what lies outside belongs to the nearest
};

/// Isaac Lab's terrain patches and origins: .npy of float32, rows x cols x most of a tile x 3 and rows x cols x 3.
struct TerrainPatches {
    std::string flat_patches, terrain_origins;
    std::size_t patches_per_tile = 0;
};

/// Patches are the points, those of a tile in their order; a tile with fewer than the fullest repeats its own from the
/// start. The origin of a tile is its first patch. Throws ArgumentError for a tile without any; but where there are no
/// points at all, there are no patches and no origins (NaN).
SPAWNFIELD_API TerrainPatches terrain_patches(std::span<const Vec3> points, const TileGrid& grid);

/// CARLA's own transforms (Python API), left-handed, m and degrees: JSON with "location" and "rotation" of each.
SPAWNFIELD_API std::string carla_json(std::span<const RobotStart> robots, const std::string& blueprint);

/// objects.json of CARLA's ROS bridge (carla_spawn_objects), whose spawn_point is in ROS's frame, but in degrees: the
/// bridge turns it over.
SPAWNFIELD_API std::string carla_objects_json(std::span<const RobotStart> robots, const std::string& blueprint);

/// name,x,y,z,qx,qy,qz,qw in one of Unity's frames.
SPAWNFIELD_API std::string unity_csv(std::span<const RobotStart> robots, Frame frame);

/// Name,X,Y,Z,Roll,Pitch,Yaw, cm and degrees: a data table of Unreal, whose first column names the rows.
SPAWNFIELD_API std::string unreal_csv(std::span<const RobotStart> robots);

}  // namespace spawnfield
