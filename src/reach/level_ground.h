#pragma once

#include "base/polygon2.h"
#include "base/rect.h"
#include "geometry/tile_tree.h"
#include "reach/lattice.h"

#include <spawnfield/judge.h>

#include <array>
#include <optional>
#include <span>
#include <utility>
#include <vector>

namespace spawnfield {

/// Proves that a robot stands on ground that is level, or nearly so, without letting it down. Most of all floors are.
/// For one thread.
///
/// The level robot stands on a plane with its centre of mass c above it, and at least m inside its support polygon. If
/// it tilts by an angle a, its mass is at least c cos(a) + m sin(a) above the plane. On ground that is at most e above
/// or below the plane, its mass is at most c + e above the plane when it starts, and then sinks until the robot rests.
/// So if 2 e <= m^2 / (2 c), it tilts at most by 4 e / m. Then all its contacts on the plane are so near to the ground
/// that they count for the margin (Settler), which is nearly m.
///
/// Where the ground ends below the robot, the same holds for the part of its feet that has ground below it.
///
/// Everything else must be farther from the robot than it moves.
///
/// It also proves that a robot does not stand at an end of the ground: one that touches level ground only with the
/// whole of its flat base, as a box does, when its mass is beyond a straight end or too near to it. All contacts are
/// before that end, so the margin is at most the distance of the mass from it. If the mass is beyond it, the robot tips
/// over it, by which the mass gets farther away.
class LevelGround {
public:
    /// How far a point of the robot may be from where it is on the plane, m. The true limit is 1 mm.
    static constexpr double tolerance = 2e-3;

    explicit LevelGround(const Judge::Impl& shared);

    /// Returns whether anything can be proven about this robot and these limits.
    bool is_possible() const { return flatness_ > 0; }
    /// Largest height of the ground above or below its layer, m.
    double flatness() const { return flatness_; }

    /// Looks for all solids at most `radius` from a place, m. The robot must lie within it.
    void set_place(const Vec2& place, double radius);
    /// Selects the layer of the place onto which the robot is let down, at a height (m). Returns false if nothing can
    /// be proven there.
    bool set_layer(double height);

    /// Looks at all that is at most `radius` from a place (m), at any height. Returns the height of the ground (m) if
    /// it is there exactly level, without ends, and above all else, and if all else is flat and less than `head_room`
    /// (m) below it. Then, on each vertical line whose own radius lies within this one, a robot that needs so much room
    /// can stand on this layer only, and is_open() holds there.
    std::optional<double> flat_ground(const Vec2& place, double radius, double head_room);

    /// Returns whether there is nothing but ground and its ends within the radius, up to above the robot.
    bool is_clear() const { return is_clear_; }
    /// The same without ends.
    bool is_open() const { return is_clear_ && !has_ends_; }
    /// Returns whether the robot stands at a yaw, as far as the geometry decides. False: not proven.
    bool stands(double yaw) const { return has_nothing_near() || stands(turned(yaw)); }
    /// The same at a heading of the drivable graph.
    bool stands_at(int heading) const { return has_nothing_near() || stands(at_headings_[std::size_t(heading)]); }
    /// Returns whether the robot does not stand there at this heading, because it tips over. False: not proven.
    bool tips_at(int heading) const { return can_tip_ && tips(at_headings_[std::size_t(heading)]); }
    /// Returns the height of its origin, m.
    double z() const { return height_ - lowest_; }

private:
    /// A convex polygon with 2 to 4 corners, counterclockwise. The corners may lie on one line.
    struct Outline {
        std::array<Vec2, 4> corners;
        std::size_t count = 0;

        std::size_t size() const { return count; }
        const Vec2& operator[](std::size_t k) const { return corners[k]; }
        std::span<const Vec2> span() const { return {corners.data(), count}; }
    };
    struct Solid {
        Outline outline;        ///< of its hull seen from above, relative to the place
        Rect box;               ///< around the outline
        double low, high;       ///< heights, m
        bool is_flat;           ///< on all vertical lines that meet it, its top is exactly at `high`
        bool is_level = false;  ///< it is terrain, and its top is a plane
        double middle = 0;      ///< height of that plane at the place, m
        double steepness = 0;   ///< its slope
    };
    /// What of the robot depends on its yaw.
    struct Turned {
        Polygon2 footprint;
        std::vector<Polygon2> feet;
        Vec2 mass;
    };
    Turned turned(double yaw) const;
    bool has_nothing_near() const { return obstacles_.empty() && ends_.empty(); }
    bool stands(const Turned& robot) const;
    bool stands_at_end(const Turned& robot) const;
    bool tips(const Turned& robot) const;
    bool is_all_ground_before(const Vec2& point, const Vec2& outward) const;
    Solid triangle(const std::array<Vec3, 3>& corners, bool is_terrain) const;
    Solid primitive(const Shape& shape, bool is_terrain) const;
    double largest_flatness(double margin) const;
    double unevenness_of(const Solid& solid) const;
    void find_ends(const Solid& solid);
    void add_near(std::vector<Outline>& list, const Outline& outline, const Rect& box) const;

    const Judge::Impl& shared_;
    Polygon2 footprint_;               ///< outline of the robot, seen from above, in its frame
    std::vector<Polygon2> feet_;       ///< lowest points of each part that has some, with 1 or more corners
    Vec3 mass_ = Vec3::Zero();         ///< centre of mass, in the robot's frame
    std::vector<Turned> at_headings_;  ///< for each heading of the drivable graph
    double lowest_ = 0, highest_ = 0;  ///< of the robot's points, in its frame, m
    double flatness_ = 0;              ///< m; 0: nothing can be proven
    bool has_flat_base_ = false;       ///< it is one polyhedron, whose lowest face is its whole outline
    double gap_ = 0;                   ///< m; what is farther than this from the footprint does not meet the robot
    double reach_ = 0;                 ///< m; largest distance of the footprint from its origin, and the gap
    Vec3 origin_ = Vec3::Zero();
    double radius_ = 0, height_ = 0;
    std::vector<Solid> solids_;
    /// There is a face of a mesh that is filled although it has holes. It can contain the robot without any face below
    /// or beside it.
    bool is_unsealed_ = false;
    bool is_clear_ = false, has_ends_ = false;  ///< for is_clear() and is_open()
    bool has_water_ = false;                    ///< there is water within the radius
    /// The ground is exactly level, has ends, and there is nothing below them that could hold the robot.
    bool can_tip_ = false;
    std::vector<const Solid*> ground_;
    double unevenness_ = 0;  ///< largest height of the ground above or below the layer, m
    /// Outlines of all else that may meet the robot, without those that are too far away at every yaw.
    std::vector<Outline> obstacles_;
    /// Edges at which the ground ends or may end, with the ground to their left.
    std::vector<Outline> ends_;
    std::vector<std::pair<double, double>> covered_;  ///< parts of the edge that was examined last, 0 .. 1
};

}  // namespace spawnfield
