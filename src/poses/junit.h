#pragma once

#include <functional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace spawnfield {

/// Takes a text in pieces.
using TextSink = std::function<void(std::string_view)>;
inline constexpr std::size_t text_piece = 1 << 20;  ///< bytes

/// A test case of a JUnit report. If `type` is empty, it passes; otherwise, it fails.
struct JunitCase {
    std::string name;
    std::string type = {}, message = {}, details = {};  ///< of the failure
    std::string group = {};                             ///< if given: the class is "map.group" in place of "map.robot"
};

struct JunitReport {
    std::string command = "check";
    std::string map, robot = {};  ///< names; the class of test cases is "map.robot"
    std::vector<std::pair<std::string, std::string>> properties;
    std::size_t cases = 0, failures = 0;
    std::function<JunitCase(std::size_t)> test_case;
};

/// Returns a text that XML can contain on one line: valid UTF-8 without control characters.
std::string xml_text(const std::string& text);

/// Writes a JUnit report. Passes the XML to the sink in pieces, so that only one piece is in memory.
void write_junit(const JunitReport& report, const TextSink& sink);

}  // namespace spawnfield
