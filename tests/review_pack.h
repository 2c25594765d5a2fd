#pragma once

#include "base/deflate.h"

#include <nlohmann/json.hpp>

#include <cstring>
#include <stdexcept>
#include <string>
#include <vector>

/// Reads a pack as docs/review-format.md describes it. Written apart from the code that makes packs.
class ReviewPack {
public:
    explicit ReviewPack(const std::string& bytes)
    {
        if (bytes.substr(0, 8) != "SPAWNRV1") throw std::runtime_error("not a pack");
        std::uint32_t length = 0;
        std::memcpy(&length, bytes.data() + 8, sizeof length);
        head = nlohmann::json::parse(bytes.substr(12, length));
        blocks_ = bytes.substr(12 + length);
    }

    nlohmann::json head;

    /// Returns the bytes of a block, which has `size` bytes when it is not compressed.
    std::string bytes(const nlohmann::json& array, std::size_t size) const
    {
        return spawnfield::inflate_bytes(
            blocks_.substr(array.at("at").get<std::size_t>(), array.at("bytes").get<std::size_t>()), size);
    }

    /// Returns a text, or plain numbers.
    std::string text(const nlohmann::json& array) const { return bytes(array, array.at("count").get<std::size_t>()); }

    /// Returns integers with the coding delta.
    std::vector<std::int64_t> integers(const nlohmann::json& array) const
    {
        const std::string type = array.at("type");
        const std::size_t count = array.at("count"), size = std::stoul(type.substr(1)) / 8;
        if (array.at("coding") != "delta") throw std::runtime_error("not delta");
        const std::string planes = bytes(array, count * size);
        std::vector<std::int64_t> out;
        std::int64_t value = 0;
        for (std::size_t i = 0; i < count; ++i) {
            std::uint64_t code = 0;
            for (std::size_t byte = 0; byte < size; ++byte)
                code |= std::uint64_t(static_cast<unsigned char>(planes[byte * count + i])) << (8 * byte);
            const auto difference = std::int64_t(code >> 1) ^ -std::int64_t(code & 1);
            const std::int64_t turn = std::int64_t(1) << (8 * size);
            value = (value + difference) % turn;
            if (type[0] == 'u' && value < 0) value += turn;
            if (type[0] == 'i' && value >= turn / 2) value -= turn;
            if (type[0] == 'i' && value < -turn / 2) value += turn;
            out.push_back(value);
        }
        return out;
    }

private:
    std::string blocks_;
};
