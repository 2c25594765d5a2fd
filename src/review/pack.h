#pragma once

#include "poses/pose_json.h"

#include <bit>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <type_traits>
#include <vector>

namespace spawnfield {

/// Collects the arrays of a pack (docs/review-format.md). Each function adds a block, and returns the object that
/// describes it in the pack's JSON.
class PackWriter {
public:
    /// `is_fast`: blocks are compressed for speed rather than size.
    explicit PackWriter(bool is_fast = false) : is_fast_(is_fast) {}

    template <class T>
    Json plain(std::span<const T> values, std::size_t width = 1)
    {
        return add(type_of<T>(), values.size() / width, width, "plain",
                   {reinterpret_cast<const char*>(values.data()), values.size_bytes()});
    }

    /// Integers: stored as differences from the one before.
    template <class T>
    Json delta(std::span<const T> values)
    {
        using Bits = std::make_unsigned_t<T>;
        std::string planes(values.size_bytes(), '\0');
        Bits before = 0;
        for (std::size_t i = 0; i < values.size(); ++i) {
            const Bits value = std::bit_cast<Bits>(values[i]), code = zigzag(Bits(value - before));
            before = value;
            for (std::size_t byte = 0; byte < sizeof(T); ++byte)
                planes[byte * values.size() + i] = char(code >> (8 * byte) & 255);
        }
        return add(type_of<T>(), values.size(), 1, "delta", planes);
    }

    Json text(std::string_view text) { return add("text", text.size(), 1, "plain", text); }

    /// Corners of a mesh: x, y, z and 0 for each.
    Json corners(std::span<const std::array<std::uint16_t, 4>> corners);
    /// Indices of its triangles: three for each. `corners`: their number.
    Json triangles(std::span<const std::uint32_t> indices, std::size_t corners);

    /// Returns the whole pack.
    std::string finish(const Json& head) const;

private:
    template <class T>
    static constexpr const char* type_of()
    {
        if constexpr (std::is_same_v<T, float>)
            return "f32";
        else if constexpr (sizeof(T) == 1)
            return "u8";
        else if constexpr (sizeof(T) == 2)
            return std::is_signed_v<T> ? "i16" : "u16";
        else
            return std::is_signed_v<T> ? "i32" : "u32";
    }

    /// Returns 0, 1, 2, 3, 4 … for the differences 0, -1, 1, -2, 2 …
    template <class Bits>
    static Bits zigzag(Bits difference)
    {
        constexpr int top = 8 * sizeof(Bits) - 1;
        return Bits((difference << 1) ^ (difference >> top ? Bits(~Bits(0)) : Bits(0)));
    }

    Json add(const char* type, std::size_t count, std::size_t width, const char* coding, std::string_view bytes);

    const bool is_fast_;
    std::string blocks_;
};

}  // namespace spawnfield
