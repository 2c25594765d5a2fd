#pragma once

#include "base/polygon2.h"
#include "base/rotation.h"
#include "settle/minimax.h"
#include "settle/near_solids.h"
#include "settle/settle.h"

#include <array>
#include <cstdint>
#include <span>
#include <vector>

namespace spawnfield {

/// Robots on their way down, one after another.
class Settler::Descent {
public:
    static constexpr std::size_t most_yaws = 64;  ///< that are kept: no rule has more headings (HeadingRule::most)

    explicit Descent(const Settler& settler);

    /// Lets the robot down between solids, which are relative to its place.
    Rest run(std::span<const NearSolid> solids, double yaw);

private:
    /// Touches that are at most this much lower than the highest one are contacts, m.
    static constexpr double contact_tolerance = 1e-9;
    /// The margin also counts wheels and feet that are at most this far above the ground, m: real ones give way by so
    /// much, and the vertices of real meshes are not more precise.
    static constexpr double contact_gap = 1e-3;
    static constexpr double tie = 1e-12;            ///< m: touches of one height, up to rounding
    static constexpr double smallest_turn = 1e-11;  ///< rad
    static constexpr double first_turn = 0.1;       ///< rad: limit of the first step
    static constexpr double straight_turn = 0.1;    ///< rad, see descend()
    static constexpr double most_seen = 0.2;        ///< m, see lower()

    /// A touch between a part of the robot and a solid.
    struct RestTouch {
        Touch touch;
        Vec2 rise;  ///< derivative of touch.height by roll and pitch, m/rad
        std::size_t part, solid;
    };

    /// The rotation of a robot.
    struct Attitude {
        Mat3 rotation;
        Vec3 roll_axis, pitch_axis;  ///< about which the robot turns if its roll or its pitch changes

        Attitude(const Mat3& rotation_, const CosSin& yaw)
            : rotation(rotation_), roll_axis(rotation.col(0)), pitch_axis(-yaw.sin, yaw.cos, 0)
        {
        }

        /// Returns the derivative by roll and pitch of how much the robot must be raised so that its point `r` stays
        /// above a plane with this normal (see Touch).
        Vec2 rise(const Vec3& r, const Vec3& normal) const
        {
            const Vec3 arm = r.cross(normal);
            return {-roll_axis.dot(arm), -pitch_axis.dot(arm)};
        }
    };

    /// The robot with a roll and a pitch, lowered onto the solids below it.
    struct Lowered {
        Vec2 angles = Vec2::Zero();  ///< roll and pitch, rad
        Mat3 rotation = Mat3::Identity();
        double z = 0;  ///< of its origin, m
        std::vector<RestTouch> touches;
        bool has_room = false;
        std::optional<std::uint32_t> wall = {};  ///< if it has no room: the part of the scene
        /// Height of the origin from which on a solid above the robot touches it, m. Solids that touch it only above
        /// `seen` do not count.
        double ceiling = std::numeric_limits<double>::infinity(), seen = ceiling;

        void clear()  // keeps the memory
        {
            angles.setZero();
            rotation.setIdentity();
            z = 0;
            touches.clear();
            has_room = false;
            wall.reset();
            ceiling = seen = std::numeric_limits<double>::infinity();
        }
    };

    /// The level robot at a yaw.
    struct Level {
        double yaw;
        Mat3 rotation;
        std::vector<PlacedBody> parts, joints;
        double bottom;  ///< z of its lowest point on the vertical line through its origin, or of its top, m
    };

    /// A part of the robot and a solid.
    struct Pair {
        double possible;  ///< see highest_possible()
        std::uint32_t part, solid;
        // Only used by level(), NaN: not known yet
        double height = std::numeric_limits<double>::quiet_NaN();  ///< of the highest touch
        double bottom = std::numeric_limits<double>::quiet_NaN();  ///< the pair touches from this height on
        bool is_ceiling = false;
    };

    struct Between {
        double height;  ///< of the level robot's origin, m
        std::size_t solid;
    };

    // descent.cpp: the way down
    void face(double yaw);
    Mat3 rotation(const Vec2& angles);
    Vec3 mass_center(const Lowered& at) const { return at.rotation * mass_; }
    bool tilts_too_far(const Mat3& rotation) const;
    double share_to_largest_tilt(const Vec2& turn);
    Rest::State descend(double straight);
    bool stands();
    bool is_balanced() const;

    // lowering.cpp: the robot at one attitude
    static double highest_possible(const PlacedBody& part, const NearSolid& solid);
    static double lowest_possible(const PlacedBody& part, const NearSolid& solid);
    const Level& level_robot(double yaw);
    void turn_parts(const Mat3& rotation);
    void set_solids(std::span<const NearSolid> solids);
    std::size_t find_near(const Bounds& robot, double low_z, double high_z);
    void find_pairs(double low_z, double high_z);
    double touch(const PlacedBody& part, const NearSolid& solid, const WantedTouches& wanted = {});
    void level(Lowered& out);
    std::optional<Between> solid_between_parts(double z);
    Pair* highest_above(double z);
    double bottom_of(const Pair& pair, double highest, double enough);
    void lower(const Vec2& angles, double z, double rise, Lowered& out);
    double ceiling_above(const Lowered& at);

    // turning.cpp: from one attitude to the next one
    Vec2 falling_turn();
    void turn_by(const Vec2& turn);
    double expected_z(const Vec2& turn) const;
    const RestTouch& carrier(const Vec2& turn) const;
    Vec2 first_part(const Vec2& aim, bool& is_to_kink);
    std::optional<Vec2> leveled(const Vec2& turn, std::span<const RestTouch* const> touches);
    double exact_kink(const Vec2& turn, double predicted, const RestTouch& carried, const RestTouch& next);
    std::optional<double> touch_height(const RestTouch& old, const Mat3& rotated);
    void land(const Vec2& turn);
    double nearest_kink(const Vec2& turn) const;
    const RestTouch& contact_at(const Vec2& place) const;
    void level_contacts();

    // rest.cpp: what is reported of a rest
    static Polygon2 support_polygon(const Lowered& at, double tolerance = contact_tolerance);
    std::vector<RestContact> rest_contacts(const Lowered& at) const;
    double tip_over(const Polygon2& polygon, const std::vector<RestContact>& contacts, const Vec3& mass) const;
    double belly(const std::vector<RestContact>& contacts);
    Rest rest(Rest::State state);

    // rocking.cpp: the other rests nearby
    void rock(Rest& rest);
    bool is_far(const Lowered& a, const Lowered& b, double turn) const;

    const Settler& settler_;
    std::span<const NearSolid> solids_;
    std::array<std::vector<double>, 3> lows_, highs_;  ///< of the bounds of solids_ along each axis
    std::vector<std::uint32_t> near_;                  ///< see find_near()
    double yaw_ = std::numeric_limits<double>::quiet_NaN();
    CosSin yaw_parts_{0};
    const double least_cosine_ = std::cos(settler_.options_.max_tilt);  ///< of the tilt
    Vec2 known_angles_;                                                 ///< the argument of the last rotation()
    Mat3 known_;                                                        ///< its result
    Mat3 placed_;                                                       ///< the rotation of parts_; NaN: none
    Vec3 mass_ = Vec3::Zero();                ///< the centre of mass in the robot's frame, moved a little
    std::vector<Level> levels_;               ///< at the last yaws
    const Level* level_ = nullptr;            ///< at yaw_
    std::vector<PlacedBody> turned_;          ///< the parts of the robot
    std::span<const PlacedBody> parts_ = {};  ///< turned_ or those of level_: at the attitude that was examined last
    std::vector<Pair> pairs_;                 ///< at the attitude that was examined last
    std::vector<Touch> touches_;              ///< of the pair that was examined last
    std::vector<MinimaxPlane> planes_;        ///< see falling_turn()
    Lowered at_, next_, start_;
    Vec2 balance_ = Vec2::Zero();  ///< angles at which it last touched the ground with an area
    double balance_z_ = 0;
    double limit_ = first_turn;  ///< of the next step in roll and pitch, rad
    bool is_stuck_ = false;      ///< see descend()
    Vec2 drift_ = Vec2::Zero();  ///< see falling_turn()
    Minimax aim_;                ///< the last result of falling_turn(), with the touches that carry the robot there
};

}  // namespace spawnfield
