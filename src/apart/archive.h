#pragma once

#include "base/binary.h"

#include <Eigen/Core>

#include <array>
#include <concepts>
#include <filesystem>
#include <optional>

namespace spawnfield {

// A type becomes bytes by a function `fields(archive, value)` that calls the archive with all members. One function
// serves for writing and for reading, so the two cannot disagree.

/// The largest value of an enumeration, whose values are 0, 1, …; a reader refuses larger ones.
template <class E>
inline constexpr E last_value = E::undefined;

namespace archive {

template <class T>
concept Number = std::is_arithmetic_v<T> && !std::same_as<T, bool>;

template <class T>
concept FixedMatrix = requires
{
    typename T::Scalar;
    requires T::SizeAtCompileTime >
    0;
};

/// Types whose arrays are written as blocks of memory: they have no padding, and each content is a valid value.
template <class T>
inline constexpr bool is_block = Number<T>;
template <Number T, std::size_t n>
inline constexpr bool is_block<std::array<T, n>> = true;

}  // namespace archive

class ArchiveWriter {
public:
    template <class... T>
    void operator()(T&... values)
    {
        (put(values), ...);
    }
    std::string take() { return out_.take(); }

private:
    void put(bool value) { out_.put(std::uint8_t(value)); }
    template <archive::Number T>
    void put(T value)
    {
        out_.put(value);
    }
    template <class T>
    requires std::is_enum_v<T>
    void put(T value) { out_.put(std::uint8_t(value)); }
    void put(const std::string& text) { out_.put_text(text); }
    void put(const std::filesystem::path& path) { out_.put_text(path.string()); }
    template <archive::FixedMatrix T>
    void put(const T& matrix)
    {
        for (const double value : matrix.reshaped()) out_.put(value);
    }
    template <class T>
    void put(std::optional<T>& value)
    {
        put(value.has_value());
        if (value) put(*value);
    }
    template <class T, std::size_t n>
    void put(std::array<T, n>& values)
    {
        for (T& value : values) put(value);
    }
    template <class T>
    void put(std::vector<T>& values)
    {
        if constexpr (archive::is_block<T>) {
            out_.put_array(values);
        } else {
            out_.put(std::uint64_t(values.size()));
            for (T& value : values) put(value);
        }
    }
    template <class T>
    requires requires(ArchiveWriter& archive, T& value) { fields(archive, value); }
    void put(T& value) { fields(*this, value); }

    BinaryWriter out_;
};

/// Throws std::out_of_range if the bytes end too early, or an enumeration does not have a value.
class ArchiveReader {
public:
    explicit ArchiveReader(std::string_view bytes) : in_(bytes) {}

    template <class... T>
    void operator()(T&... values)
    {
        (get(values), ...);
    }

private:
    void get(bool& value) { value = in_.get<std::uint8_t>() != 0; }
    template <archive::Number T>
    void get(T& value)
    {
        value = in_.get<T>();
    }
    template <class T>
    requires std::is_enum_v<T>
    void get(T& value)
    {
        const auto number = in_.get<std::uint8_t>();
        if (number > std::uint8_t(last_value<T>)) throw std::out_of_range("enumeration");
        value = T(number);
    }
    void get(std::string& text) { text = in_.get_text(); }
    void get(std::filesystem::path& path) { path = in_.get_text(); }
    template <archive::FixedMatrix T>
    void get(T& matrix)
    {
        for (double& value : matrix.reshaped()) value = in_.get<double>();
    }
    template <class T>
    void get(std::optional<T>& value)
    {
        bool has_value = false;
        get(has_value);
        value.reset();
        if (has_value) get(value.emplace());
    }
    template <class T, std::size_t n>
    void get(std::array<T, n>& values)
    {
        for (T& value : values) get(value);
    }
    template <class T>
    void get(std::vector<T>& values)
    {
        if constexpr (archive::is_block<T>) {
            values = in_.get_array<T>();
        } else {
            values.clear();  // grows as far as there are bytes, whatever the count says
            for (auto left = in_.get<std::uint64_t>(); left > 0; --left) get(values.emplace_back());
        }
    }
    template <class T>
    requires requires(ArchiveReader& archive, T& value) { fields(archive, value); }
    void get(T& value) { fields(*this, value); }

    BinaryReader in_;
};

}  // namespace spawnfield
