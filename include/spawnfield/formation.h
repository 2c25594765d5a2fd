#pragma once

#include <spawnfield/export.h>
#include <spawnfield/island_choice.h>
#include <spawnfield/judge.h>
#include <spawnfield/reach.h>

#include <optional>
#include <string>
#include <vector>

namespace spawnfield {

/// An arrangement of robots, seen from above. Robots have numbers from 0 on; the first one is robot 0.
struct Formation {
    enum class Form : std::uint8_t {
        Line,    ///< side by side, the first one on the left
        Grid,    ///< rows behind each other, in each of them `columns` robots side by side
        Circle,  ///< on a circle, counterclockwise; all look at its middle
        Convoy   ///< behind each other along `path`, the first one in front, the last one at the start of the path
    };
    Form form = Form::Line;
    double spacing = 1;  ///< m between neighbours, seen from above, > 0; of a convoy, along the path
    int columns = 0;     ///< only for Grid; 0: the smallest number whose square is at least the number of robots
    /// The middle of the line, of the grid's first row, or of the circle. Without z, robots stand on the highest
    /// layer. No value: the place is drawn, uniformly by area for the first robot. Not for Convoy.
    std::optional<StartPlace> at = {};
    /// Where all robots of a line or a grid look, and where the first robot of a circle is, seen from its middle: rad.
    /// No value: 0 if `at` is given; otherwise, it is drawn. Not for Convoy.
    std::optional<double> heading = {};
    /// Only for Convoy: corners of the path, at least two, m. A z that is NaN means the highest layer.
    std::vector<Vec3> path = {};
};

/// The place of a robot in a formation.
struct FormationSlot {
    double x = 0, y = 0, yaw = 0;  ///< m, rad
    std::optional<double> z = {};  ///< the robot stands on the layer that is nearest to this height; none: the highest
};

/// Returns the places of `count` robots around `at`, which look to `heading` (rad). Not for Convoy. Throws
/// ArgumentError for options beyond their limits.
SPAWNFIELD_API std::vector<FormationSlot> formation_slots(const Formation& formation, std::size_t count,
                                                          const StartPlace& at, double heading);

/// Returns the places of a convoy whose last robot is `start` m after the start of the path, seen from above; robots
/// look along the path. Empty if the path is too short. Throws ArgumentError for options beyond their limits.
SPAWNFIELD_API std::vector<FormationSlot> convoy_slots(const Formation& formation, std::size_t count, double start);

/// Returns the length of the formation's path, seen from above, m.
SPAWNFIELD_API double path_length(const Formation& formation);

/// Throws ArgumentError if a robot that is let down at a place can stand at none of the 16 headings of the graph. Then
/// drivable_path() finds no path. `what` is the name of the place in the message.
SPAWNFIELD_API void check_standing(const Judge& judge, const std::string& what, const StartPlace& place);

/// Returns the corners of a path on which the robot drives from one place to another, for Formation::path; z is the
/// height of the ground. At both places, the robot is let down at the 16 headings of the graph; the first heading from
/// which there is a path is used. The judge must be that of the graph, and the graph must keep its ways. Throws
/// ArgumentError if the robot can stand at none of the headings, or if no path leads from one place to the other.
SPAWNFIELD_API std::vector<Vec3> drivable_path(const Judge& judge, const ReachGraph& graph, const StartPlace& from,
                                               const StartPlace& to);

}  // namespace spawnfield
