#pragma once

#include <spawnfield/query.h>
#include <spawnfield/terrain.h>

#define XXH_STATIC_LINKING_ONLY  // for the size of XXH64_state_t
#include <xxhash.h>

#include <string_view>
#include <type_traits>

namespace bench {

/// XXH64 (Collet, xxHash) of values that are added field by field, because the bytes of a struct include padding.
class Digest {
public:
    Digest() { XXH64_reset(&state_, 0); }

    Digest& add(std::string_view bytes)
    {
        XXH64_update(&state_, bytes.data(), bytes.size());
        return *this;
    }
    template <class T>
    requires(std::has_unique_object_representations_v<T> || std::is_floating_point_v<T>) Digest& add(const T& value)
    {
        return add(std::string_view(reinterpret_cast<const char*>(&value), sizeof value));
    }
    Digest& add(const spawnfield::Vec3& v)
    {
        return add(std::string_view(reinterpret_cast<const char*>(v.data()), sizeof v));
    }
    template <class T>
    Digest& add_all(const std::vector<T>& values)
    {
        for (const T& value : values) add(value);
        return add(values.size());
    }
    std::uint64_t value() const { return XXH64_digest(&state_); }

private:
    XXH64_state_t state_;
};

std::uint64_t digest_of(const spawnfield::Scene& scene);
std::uint64_t digest_of(const spawnfield::Geometry& geometry);
std::uint64_t digest_of(const spawnfield::TerrainMap& terrain);
std::uint64_t digest_of(const std::vector<spawnfield::Judgement>& judgements);
std::uint64_t digest_of(const spawnfield::RasterResult& raster);
std::uint64_t digest_of(const spawnfield::SpawnList& spawns);

}  // namespace bench
