#pragma once

#include <spawnfield/types.h>

#include <array>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace spawnfield {

/// Angles in radians beyond a whole turn, which are likely degrees: for roll, pitch and yaw.
struct BeyondTurn {
    struct Angle {
        std::size_t rows = 0;
        std::string first = {};  ///< line and value of the first of these, for the notice
    };
    std::array<Angle, 3> angles;

    /// Adds what was found in later rows.
    void add(const BeyondTurn& later);
};

/// Reads the rows of a CSV file of poses by the columns that its header names. The names begin with a prefix.
class PoseRows {
public:
    PoseRows() = default;
    /// Reads a header, which is a line of the file. Throws FileError.
    PoseRows(std::string file, std::string prefix, std::string_view header, std::uint64_t line);

    /// Returns the pose of a row, which is this line of the file. Throws FileError, which names line and column.
    Pose pose(std::string_view row, std::uint64_t line, BeyondTurn& beyond) const;

    /// Returns notices about columns that are not read although their names look like those of a pose.
    std::vector<std::string> name_notices() const;
    /// Returns a notice for each angle with values beyond a whole turn.
    std::vector<std::string> turn_notices(const BeyondTurn& beyond) const;

    /// Returns what a header must have, in words.
    static std::string needed_header(const std::string& prefix);

private:
    /// The column of an angle: roll, pitch or yaw.
    struct AngleColumn {
        std::string name;
        int field = -1;  ///< its index; -1: not in the file
        bool is_degrees = false;
    };

    /// Throws FileError about a line of the file.
    [[noreturn]] void fail(std::uint64_t line, const std::string& what) const;
    std::string columns(const std::string& names) const;
    double number_in(std::string_view field, std::string_view column, std::uint64_t line) const;
    int field_of(const std::string& column, std::uint64_t line) const;
    AngleColumn angle_column(const std::string& name, std::uint64_t line) const;
    void check_columns(std::uint64_t line) const;

    std::string file_, prefix_;
    std::vector<std::string> names_;     ///< of all columns
    std::array<int, 3> position_{};      ///< the fields of x, y, z
    std::array<int, 4> quaternion_{};    ///< the fields of qx, qy, qz, qw; -1: not in the file
    std::array<AngleColumn, 3> angles_;  ///< roll, pitch, yaw
};

}  // namespace spawnfield
