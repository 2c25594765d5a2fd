#pragma once

#include "base/binary.h"

#include <initializer_list>
#include <string>
#include <vector>

namespace spawnfield {

/// Returns the bytes of an array in C order (last index fastest) as numpy.save writes them: version 1.0, little-endian.
/// Source: NumPy Enhancement Proposal 1, A Simple File Format for NumPy Arrays.
template <class T>
std::string npy(std::initializer_list<std::size_t> shape, const std::vector<T>& values)
{
    static_assert(std::is_same_v<T, double> || std::is_same_v<T, float>);
    std::string header = std::string("{'descr': '<f") + (sizeof(T) == 8 ? "8" : "4") +
                         "', 'fortran_order': False, 'shape': (";
    for (const std::size_t length : shape) header += std::to_string(length) + ", ";
    if (shape.size() > 1) header.resize(header.size() - 2);
    header += "), }";
    constexpr std::size_t preamble = 10, alignment = 64;
    header.append(alignment - 1 - (preamble + header.size()) % alignment, ' ');
    header += '\n';
    BinaryWriter length;
    length.put(std::uint16_t(header.size()));
    std::string bytes = std::string("\x93NUMPY\x01\x00", 8) + length.take() + header;
    bytes.append(reinterpret_cast<const char*>(values.data()), values.size() * sizeof(T));
    return bytes;
}

}  // namespace spawnfield
