#pragma once

#include "apart/archive.h"

#include <spawnfield/robot.h>
#include <spawnfield/scene.h>

#include <string>

// All members of a scene, of a robot, and of the options with which they are read, for archives.
namespace spawnfield {

template <>
inline constexpr Label last_value<Label> = Label::Ignore;
template <>
inline constexpr ShapeKind last_value<ShapeKind> = ShapeKind::Hull;
template <>
inline constexpr Unknown last_value<Unknown> = Unknown::Blocked;
template <>
inline constexpr Drive last_value<Drive> = Drive::Car;

template <class A>
void fields(A& archive, Pose& pose)
{
    archive(pose.position, pose.rotation);
}
template <class A>
void fields(A& archive, Shape& shape)
{
    archive(shape.kind, shape.size, shape.pose);
}
template <class A>
void fields(A& archive, Bounds& bounds)
{
    archive(bounds.min, bounds.max);
}

template <class A>
void fields(A& archive, Part& part)
{
    archive(part.name, part.kind, part.label, part.solid_pieces, part.sheet_pieces, part.open_edges, part.triangles);
}
template <class A>
void fields(A& archive, Piece& piece)
{
    archive(piece.part, piece.first_triangle, piece.triangle_count, piece.solid, piece.open, piece.sides_up,
            piece.bottom);
}
template <class A>
void fields(A& archive, Primitive& primitive)
{
    archive(primitive.shape, primitive.part, primitive.label);
}
template <class A>
void fields(A& archive, GeoOrigin& origin)
{
    archive(origin.x, origin.y, origin.unit, origin.crs);
}
template <class A>
void fields(A& archive, NameRule& rule)
{
    archive(rule.what, rule.label, rule.count);
}
template <class A>
void fields(A& archive, FaceGroup& group)
{
    archive(group.part, group.node, group.material, group.triangles, group.low, group.high);
}
template <class A>
void fields(A& archive, Scene& scene)
{
    archive(scene.name, scene.parts, scene.vertices, scene.triangles, scene.triangle_labels, scene.triangle_pieces,
            scene.pieces, scene.primitives, scene.origin, scene.notices, scene.missing, scene.rules, scene.face_groups,
            scene.triangle_groups, scene.is_unlabelled, scene.has_moving_parts, scene.map_bounds);
}
template <class A>
void fields(A& archive, LabelRule& rule)
{
    archive(rule.pattern, rule.label);
}
template <class A>
void fields(A& archive, TimeWindow& window)
{
    archive(window.from, window.to);
}
template <class A>
void fields(A& archive, SceneOptions& options)
{
    archive(options.labels, options.auto_slope, options.up, options.scale, options.wall_height, options.model_paths,
            options.allow_missing, options.strict, options.any_mesh, options.heightmap, options.bounds, options.time,
            options.unknown);
}

template <class A>
void fields(A& archive, JointPosition& joint)
{
    archive(joint.joint, joint.value);
}
template <class A>
void fields(A& archive, RobotPart& part)
{
    archive(part.shape, part.hull_vertices, part.hull_faces, part.name);
}
template <class A>
void fields(A& archive, MeshFit& fit)
{
    archive(fit.name, fit.file, fit.parts, fit.volume, fit.mesh_volume);
}
template <class A>
void fields(A& archive, RobotDrive& drive)
{
    archive(drive.kind, drive.max_step, drive.turning_radius, drive.wheel_radius);
}
template <class A>
void fields(A& archive, Robot& robot)
{
    archive(robot.name, robot.parts, robot.contacts, robot.notices, robot.meshes, robot.joints, robot.mesh_parts,
            robot.mass_center, robot.drive);
}
template <class A>
void fields(A& archive, RobotOptions& options)
{
    archive(options.model_paths, options.joints, options.mesh_parts, options.any_mesh);
}

/// Return what is wrong with a scene or a robot that another process has sent: an index that points nowhere, a count
/// that does not match, a coordinate that is not finite. Empty: nothing.
std::string fault_of(const Scene& scene);
std::string fault_of(const Robot& robot);

}  // namespace spawnfield
