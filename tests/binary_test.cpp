#include "base/binary.h"

#include "catch.h"

#include <array>
#include <random>

using namespace spawnfield;

namespace {

template <class T>
std::vector<T> read_again(const std::vector<T>& values, std::uint64_t most)
{
    BinaryWriter out;
    out.put_runs(values);
    out.put(std::uint8_t(42));
    const std::string bytes = out.take();
    BinaryReader in(bytes);
    std::vector<T> read = in.get_runs<T>(most);
    CHECK(in.get<std::uint8_t>() == 42);  // nothing more was read
    return read;
}

}  // namespace

TEST_CASE("runs of equal values are read as they were written, and need little space")
{
    CHECK(read_again<int>({}, 0).empty());
    for (const std::vector<int>& values : {std::vector{7}, {1, 1, 1, 2, 2, 1}, {1, 2, 3}, std::vector<int>(100000, 5)})
        CHECK(read_again(values, values.size()) == values);
    std::mt19937 random(1);
    std::vector<std::array<std::uint8_t, 3>> many(10000);
    for (auto& value : many) value = {std::uint8_t(random() % 2), 0, std::uint8_t(random() % 2)};
    CHECK(read_again(many, many.size()) == many);
    const auto signs = read_again<double>({0.0, -0.0, -0.0}, 3);
    CHECK((!std::signbit(signs[0]) && std::signbit(signs[1]) && std::signbit(signs[2])));
    BinaryWriter out;
    out.put_runs(std::vector<double>(1000000, 0.1));
    CHECK(out.take().size() < 50);
}

TEST_CASE("runs that are longer than they may be, or damaged, are refused")
{
    CHECK_THROWS_AS(read_again<int>({1, 1, 2}, 2), std::out_of_range);
    BinaryWriter out;
    out.put_array(std::vector{1, 2});
    out.put_array(std::vector<std::uint32_t>{3});  // the length of the second run is missing
    const std::string bytes = out.take();
    CHECK_THROWS_AS(BinaryReader(bytes).get_runs<int>(100), std::out_of_range);
}
