#pragma once

#include "model/collision_geometry.h"
#include "model/model_paths.h"

#include <spawnfield/joints.h>

#include <map>
#include <string>

namespace spawnfield {

/// All <collision> elements of a URDF or SDF model, with its joints at given positions. The model is a robot, or a
/// world that is spawned as a URDF.
struct JointedModel {
    std::string name;
    std::vector<CollisionBody> bodies;  ///< names: model, link, collision; the last may be empty
    std::vector<std::string> notices;
    double mass = 0;                  ///< of all links with <inertial>, kg
    Vec3 mass_moment = Vec3::Zero();  ///< the sum of their masses times their centres of mass, kg m
    struct LinkMass {
        double mass;   ///< kg
        Vec3 centre;   ///< of mass, in the robot's frame
        Mat3 inertia;  ///< about the centre of mass, in the robot's axes, kg m2
    };
    std::vector<LinkMass> masses = {};  ///< of these links

    /// By the name of a link: the axis about which it can turn without limits, in the frame of the model.
    std::map<std::string, Vec3> axles = {};

    /// Adds a link. Its inertia is about its centre of mass, in the axes of `centre`.
    void add_mass(double kilograms, const Pose& centre, const Mat3& link_inertia)
    {
        mass += kilograms;
        mass_moment += kilograms * centre.position;
        masses.push_back({kilograms, centre.position, centre.rotation * link_inertia * centre.rotation.transpose()});
    }
};

/// Reads a URDF. Poses are in the frame of its root link. The given joints have their given positions, all others 0.
/// Throws FileError, and ArgumentError for wrong joints.
JointedModel read_urdf_model(const std::filesystem::path& file, const std::vector<JointPosition>& joints);

/// Reads the <model> of an SDF file. Poses are in the model's own frame: its <pose> is ignored. The given joints have
/// their given positions, all others 0. Throws FileError, and ArgumentError for wrong joints.
JointedModel read_sdf_model(const std::filesystem::path& file, ModelPaths& paths,
                            const std::vector<JointPosition>& joints);

}  // namespace spawnfield
