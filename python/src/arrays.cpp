#include "arrays.h"

#include <nanobind/stl/string.h>

#include <spawnfield/error.h>

#include <Eigen/Geometry>

#include <cmath>
#include <string>

namespace spawnfield::python {
namespace {

[[noreturn]] void refuse_row(std::size_t row, const std::string& what)
{
    throw ArgumentError("--poses: row " + std::to_string(row) + " " + what);
}

Pose pose_of(std::span<const double> numbers, std::size_t row)
{
    for (const double number : numbers)
        if (!std::isfinite(number)) refuse_row(row, "has a number that is not finite");
    Pose out{{numbers[0], numbers[1], numbers[2]}};
    if (numbers.size() == 4) out.rotation = rotation_from_rpy(0, 0, numbers[3]);
    if (numbers.size() == 6) out.rotation = rotation_from_rpy(numbers[3], numbers[4], numbers[5]);
    if (numbers.size() == 7) {
        const Eigen::Quaterniond turn(numbers[6], numbers[3], numbers[4], numbers[5]);
        if (!(turn.norm() > 1e-6)) refuse_row(row, "has a quaternion of length 0");
        out.rotation = turn.normalized().toRotationMatrix();
    }
    return out;
}

}  // namespace

void append_pose(std::vector<double>& out, const Pose& pose)
{
    const Eigen::Quaterniond turn(pose.rotation);
    out.insert(out.end(),
               {pose.position.x(), pose.position.y(), pose.position.z(), turn.x(), turn.y(), turn.z(), turn.w()});
}

std::vector<Pose> poses_of(const Numbers& numbers)
{
    const std::size_t width = numbers.ndim() == 2 ? numbers.shape(1) : 0;
    if (width != 3 && width != 4 && width != 6 && width != 7)
        throw ArgumentError(
            "--poses needs an array of shape (n, 3): x, y, z; (n, 4): and yaw; (n, 6): and roll, pitch, yaw; or (n, "
            "7): and a quaternion x, y, z, w; m and rad");
    std::vector<Pose> out;
    out.reserve(numbers.shape(0));
    for (std::size_t row = 0; row < numbers.shape(0); ++row)
        out.push_back(pose_of({numbers.data() + row * width, width}, row));
    return out;
}

std::vector<std::string> rows_of(const Numbers& numbers)
{
    std::vector<std::string> out(numbers.shape(0));
    const std::size_t width = numbers.shape(1);
    for (std::size_t row = 0; row < out.size(); ++row)
        for (std::size_t k = 0; k < width; ++k)
            out[row] += (k > 0 ? "," : "") +
                        nb::cast<std::string>(nb::repr(nb::float_(numbers.data()[row * width + k])));
    return out;
}

}  // namespace spawnfield::python
