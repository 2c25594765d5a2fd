#pragma once

#include <nanobind/nanobind.h>
#include <nanobind/ndarray.h>

#include <spawnfield/types.h>

#include <cstddef>
#include <initializer_list>
#include <span>
#include <utility>
#include <string>
#include <vector>

namespace spawnfield::python {

namespace nb = nanobind;

/// Returns a numpy array that owns the values, without a copy. The product of `shape` is the number of values.
template <class T>
nb::object array_of(std::vector<T> values, std::initializer_list<std::size_t> shape)
{
    auto* const held = new std::vector<T>(std::move(values));
    nb::capsule owner(held, [](void* p) noexcept { delete static_cast<std::vector<T>*>(p); });
    return nb::cast(nb::ndarray<nb::numpy, T>(held->data(), shape.size(), shape.begin(), owner));
}

template <class T>
nb::object array_of(std::vector<T> values)
{
    const std::size_t size = values.size();
    return array_of(std::move(values), {size});
}

/// Appends x, y, z and the quaternion x, y, z, w of a pose; m.
void append_pose(std::vector<double>& out, const Pose& pose);

/// Read-only numbers in C order on the CPU, from numpy, torch or anything else with DLPack.
using Numbers = nb::ndarray<const double, nb::c_contig, nb::device::cpu>;
using Indices = nb::ndarray<const std::int64_t, nb::c_contig, nb::device::cpu>;

/// Returns the poses of an array of shape (n, 3): x, y, z; (n, 4): and yaw; (n, 6): and roll, pitch, yaw; or (n, 7):
/// and a quaternion x, y, z, w, which need not have the length 1. m and rad. Throws ArgumentError for other shapes,
/// numbers that are not finite, and quaternions of length 0.
std::vector<Pose> poses_of(const Numbers& numbers);

/// Returns the rows of a CSV file with these numbers.
std::vector<std::string> rows_of(const Numbers& numbers);

}  // namespace spawnfield::python
