#pragma once

#include "base/polygon2.h"
#include "reach/lattice.h"

#include <spawnfield/collision.h>
#include <spawnfield/reach.h>
#include <spawnfield/robot_parts.h>

#include <array>
#include <map>
#include <optional>
#include <tuple>
#include <vector>

/// The drivable graph, written from its definition (ReachGraph) alone: pose by pose, with Judge::settle for each state,
/// and FCL for each way. The robot must consist of boxes and hulls.
namespace slow {

struct ReachPlace {
    double ground = 0;
    std::array<std::optional<spawnfield::SettledPose>, spawnfield::lattice_headings> poses;  ///< the valid ones
};

class Reach {
public:
    /// Column, row, index in the column, heading.
    using State = std::array<int, 4>;
    /// From one pose to another one; corner: of a curve.
    struct Course {
        spawnfield::Vec2 begin, end;
        double yaw, turn;
        std::optional<spawnfield::Vec2> corner = {};
    };
    static double length(const Course& course);  ///< m

    /// `options` must have all values. `surfaces`: those of the judge's map, without anything filled. They decide what
    /// the robot meets on its way: it is not inside anything at both ends, so it is not inside on the way if it meets
    /// no surface.
    Reach(const spawnfield::Judge& judge, const spawnfield::ReachOptions& options, const spawnfield::RasterGrid& grid,
          const spawnfield::Geometry& surfaces);

    const std::vector<ReachPlace>& places(int col, int row) const { return places_[std::size_t(row * cols_ + col)]; }
    /// The index in its column of the place to which a way leads; nothing: there is no way.
    std::optional<int> target(const State& from, spawnfield::Way way) const;
    bool has_way(const State& from, spawnfield::Way way) const { return target(from, way).has_value(); }

private:
    struct Posed {
        spawnfield::Vec3 position;
        double roll, pitch, yaw;
    };
    static std::pair<spawnfield::Vec2, double> at(const Course& course, double part);
    Course course(const State& from, const State& to, spawnfield::Way way) const;
    spawnfield::Vec2 at(int col, int row) const;
    double slope(const spawnfield::Vec2& place, double ground, const spawnfield::Vec2& ahead) const;
    double step(const spawnfield::Vec2& a, double ground_a, const spawnfield::Vec2& b, double ground_b) const;
    std::optional<int> next_place(const State& from, int col, int row, int heading) const;
    std::optional<int> end_of_ground(const State& from, spawnfield::Way way) const;
    std::optional<int> target_of_car(const State& from, spawnfield::Way way) const;
    std::optional<spawnfield::SettledPose> next_stop(const spawnfield::SettledPose& from, const spawnfield::Vec2& to,
                                                     double yaw) const;
    bool can_follow(const Course& course, const spawnfield::SettledPose& a, const spawnfield::SettledPose& b) const;
    bool passes_kink(const State& from, const State& to, spawnfield::Way way) const;
    std::array<int, 2> pieces(const spawnfield::SettledPose& a, const spawnfield::SettledPose& b, bool turns) const;
    bool is_possible(const std::vector<Posed>& poses) const;
    const spawnfield::SettledPose& pose(const State& state) const
    {
        return *places(state[0], state[1])[std::size_t(state[2])].poses[std::size_t(state[3])];
    }
    bool is_free(const std::vector<Posed>& poses, double lift_begin, double lift_end) const;
    bool is_hull_free(const spawnfield::RobotPart& part, const Posed& a, const Posed& b) const;

    const spawnfield::Judge& judge_;
    const spawnfield::ReachOptions options_;
    const spawnfield::RasterGrid grid_;
    const spawnfield::Lattice lattice_;
    const spawnfield::Geometry surfaces_;
    const int cols_, rows_;
    std::vector<std::vector<ReachPlace>> places_;
};

/// Returns the corners of a part in the robot's frame: of a box or a hull.
std::vector<spawnfield::Vec3> corners_of(const spawnfield::RobotPart& part);

}  // namespace slow
