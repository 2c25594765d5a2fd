#include "base/parallel.h"
#include "base/tile_store.h"
#include "catch.h"
#include "temp_folder.h"

#include <spawnfield/error.h>

#include <xxhash.h>

#include <algorithm>
#include <cinttypes>
#include <cstdio>
#include <filesystem>
#include <fstream>

using namespace spawnfield;

namespace {

constexpr std::uint64_t tile_size = 2048;

/// A file of zeros with tiles of 2 KB in one level. `size` bytes take no room on disk.
struct SparseFile : TempFolder {
    const std::string file = (*this / "tiles.bin").string();

    explicit SparseFile(std::uint64_t size)
    {
        write("tiles.bin", "");
        std::filesystem::resize_file(file, size);
    }

    TileStore open() const
    {
        const std::uint64_t count = std::filesystem::file_size(file) / tile_size;
        const std::string zeros(tile_size, '\0');
        TileLevel level(1, std::uint32_t(count), 1, 1);
        for (std::uint64_t t = 0; t < count; ++t)
            level.tiles.push_back({t * tile_size, tile_size, XXH64(zeros.data(), zeros.size(), 0)});
        return {{std::move(level)}, map_file(file), file};
    }
};

bool is_copy(const TileStore& store, std::string_view tile)
{
    const char* const first = store.bytes().data();
    return tile.data() < first || tile.data() >= first + store.bytes().size();
}

/// Returns how much of the mapping that contains an address is in memory, bytes: Rss in /proc/self/smaps.
std::size_t resident_around(const char* address)
{
    std::ifstream in("/proc/self/smaps");
    const auto wanted = reinterpret_cast<std::uintptr_t>(address);
    bool is_wanted = false;
    for (std::string line; std::getline(in, line);) {
        std::uintptr_t from = 0, to = 0;
        std::size_t kilobytes = 0;
        if (std::sscanf(line.c_str(), "%" SCNxPTR "-%" SCNxPTR " ", &from, &to) == 2)
            is_wanted = wanted >= from && wanted < to;
        else if (is_wanted && std::sscanf(line.c_str(), "Rss: %zu kB", &kilobytes) == 1)
            return kilobytes << 10;
    }
    FAIL("no mapping contains the address");
    return 0;
}

const auto trust = [](std::string_view) { return true; };

constexpr std::uint64_t small = 1 << 20, large = 80 << 20;  // bytes

}  // namespace

TEST_CASE("the first tiles of a large file are copied, and then tiles are mapped, for any number of threads")
{
    const SparseFile folder(large);
    for (const int threads : {1, 2, 8}) {
        CAPTURE(threads);
        const TileStore store = folder.open();
        std::atomic<std::size_t> copies{0}, wrong{0};
        const std::size_t count = store.levels()[0].tiles.size();
        parallel_for(4 * count, threads, {}, [&](std::size_t k) {
            const std::size_t t = k * 7919 % count;  // each tile four times
            const std::string_view tile = store.open(0, t, trust);
            wrong += tile.size() != tile_size || tile.find_first_not_of('\0') != std::string_view::npos;
            wrong += tile.data() != store.open(0, t, trust).data();
            copies += is_copy(store, tile);
        });
        CHECK(wrong == 0);
        CHECK(copies > count / 2);  // most of a quarter of the tiles, four times
        CHECK(copies <= count);
    }
}

TEST_CASE("no tile is copied in a small file, or if all tiles are expected to be needed")
{
    const TileStore in_small = SparseFile(small).open();
    CHECK_FALSE(is_copy(in_small, in_small.open(0, 3, trust)));
    const SparseFile folder(large);
    const TileStore store = folder.open();
    CHECK(is_copy(store, store.open(0, 3, trust)));
    store.expect_all();
    CHECK(is_copy(store, store.open(0, 3, trust)));
    CHECK_FALSE(is_copy(store, store.open(0, 4, trust)));
}

TEST_CASE("the pages of a large file are returned to the system while its tiles are opened, unless all are expected")
{
    const SparseFile folder(large);
    for (const bool expects_all : {false, true}) {
        CAPTURE(expects_all);
        const TileStore store = folder.open();
        if (expects_all) store.expect_all();
        std::size_t most = 0;
        const std::size_t count = store.levels()[0].tiles.size();
        for (std::size_t t = 0; t < count; ++t) {
            store.open(0, t, trust);
            if (t % 256 == 0) most = std::max(most, resident_around(store.bytes().data()));
        }
        if (expects_all)
            CHECK(most > large / 2);
        else
            CHECK(most < large / 4);
    }
}

TEST_CASE("a copied tile is checked, and a file that becomes shorter is an error")
{
    const SparseFile folder(large);
    const TileStore store = folder.open();
    CHECK_THROWS_AS(store.open(0, 1, [](std::string_view) { return false; }), FileError);
    {
        std::fstream out(folder.file, std::ios::in | std::ios::out | std::ios::binary);
        out.seekp(5 * tile_size);
        out << 1;
    }
    CHECK_THROWS_WITH(store.open(0, 5, trust), Contains("tiles.bin: is damaged (tile 5 of level 0 has another"));
    std::filesystem::resize_file(folder.file, large / 2);
    CHECK_THROWS_WITH(store.open(0, store.levels()[0].tiles.size() - 1, trust),
                      Contains("tiles.bin: cannot be read any more, or was cut short; bake the map again"));
}
