#pragma once

#include <algorithm>
#include <bit>
#include <cstdint>
#include <cstring>
#include <limits>
#include <numeric>
#include <span>
#include <stdexcept>
#include <string>
#include <string_view>
#include <type_traits>
#include <vector>

namespace spawnfield {

static_assert(std::endian::native == std::endian::little,
              "the map's binary files are little-endian; this machine needs a byte swap");

/// Collects numbers, arrays and texts as bytes. Numbers are appended one by one, never as a struct, whose padding has
/// no defined value.
class BinaryWriter {
public:
    template <class T>
    void put(T value)
    {
        static_assert(std::is_arithmetic_v<T>);
        bytes_.append(reinterpret_cast<const char*>(&value), sizeof value);
    }
    /// Appends a u64 count, then the values. Their type must have no padding.
    template <class T>
    void put_array(const std::vector<T>& values)
    {
        static_assert(std::is_trivially_copyable_v<T>);
        put(std::uint64_t(values.size()));
        bytes_.append(reinterpret_cast<const char*>(values.data()), values.size() * sizeof(T));
    }
    /// Appends the values as runs of equal ones: each value once, then the lengths. Their type must have no padding.
    template <class T>
    void put_runs(const std::vector<T>& values)
    {
        std::vector<T> of_runs;
        std::vector<std::uint32_t> lengths;
        for (std::size_t begin = 0, end = 0; begin < values.size(); begin = end) {
            const std::size_t last = std::min(values.size(), begin + std::numeric_limits<std::uint32_t>::max());
            while (end < last && std::memcmp(&values[begin], &values[end], sizeof(T)) == 0) ++end;
            of_runs.push_back(values[begin]);
            lengths.push_back(std::uint32_t(end - begin));
        }
        put_array(of_runs);
        put_array(lengths);
    }
    /// Appends what another writer has collected.
    void put_all(BinaryWriter other) { bytes_ += other.bytes_; }
    /// Appends a u32 length, then the text.
    void put_text(const std::string& text)
    {
        put(std::uint32_t(text.size()));
        bytes_ += text;
    }
    std::string take() { return std::move(bytes_); }

private:
    std::string bytes_;
};

/// Reads what BinaryWriter wrote, in the same order. Throws std::out_of_range if the bytes end too early.
class BinaryReader {
public:
    explicit BinaryReader(std::string_view bytes) : rest_(bytes) {}

    template <class T>
    T get()
    {
        T value;
        std::memcpy(&value, take(sizeof value), sizeof value);
        return value;
    }
    template <class T>
    std::vector<T> get_array()
    {
        const auto count = get<std::uint64_t>();
        const char* const start = take_array<T>(count);
        std::vector<T> values(count);
        if (count > 0) std::memcpy(static_cast<void*>(values.data()), start, count * sizeof(T));
        return values;
    }
    /// Reads at most `most` values that put_runs() wrote.
    template <class T>
    std::vector<T> get_runs(std::uint64_t most)
    {
        const std::vector<T> of_runs = get_array<T>();
        const auto lengths = get_array<std::uint32_t>();
        const auto count = std::accumulate(lengths.begin(), lengths.end(), std::uint64_t(0));
        if (lengths.size() != of_runs.size() || count > most) throw std::out_of_range("runs");
        std::vector<T> values;
        values.reserve(count);
        for (std::size_t k = 0; k < lengths.size(); ++k) values.insert(values.end(), lengths[k], of_runs[k]);
        return values;
    }
    /// Returns a view of `count` values without a count before them. They must be aligned.
    template <class T>
    std::span<const T> view_array(std::uint64_t count)
    {
        return {reinterpret_cast<const T*>(take_array<T>(count)), std::size_t(count)};
    }
    std::string get_text()
    {
        const auto size = get<std::uint32_t>();
        return std::string(take(size), size);
    }

private:
    template <class T>
    const char* take_array(std::uint64_t count)
    {
        if (count > rest_.size() / sizeof(T)) throw std::out_of_range("array");
        return take(count * sizeof(T));
    }
    const char* take(std::size_t size)
    {
        if (size > rest_.size()) throw std::out_of_range("value");
        const char* const start = rest_.data();
        rest_.remove_prefix(size);
        return start;
    }
    std::string_view rest_;
};

}  // namespace spawnfield
