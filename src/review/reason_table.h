#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <unordered_map>
#include <vector>

namespace spawnfield {

/// The reasons of many poses. Most differ only in their numbers, so that each text is stored once, with U+0001 in the
/// place of each number.
class ReasonTable {
public:
    /// Adds the reason of the next pose; "": none.
    void add(std::string_view reason);

    const std::vector<std::string>& texts() const { return texts_; }        ///< the first one is ""
    const std::vector<std::uint16_t>& indices() const { return indices_; }  ///< in texts(), one for each pose
    const std::string& numbers() const { return numbers_; }                 ///< of all poses, one on each line

private:
    std::unordered_map<std::string, std::uint16_t> known_{{"", 0}};
    std::vector<std::string> texts_{""};
    std::vector<std::uint16_t> indices_;
    std::string numbers_;
};

}  // namespace spawnfield
