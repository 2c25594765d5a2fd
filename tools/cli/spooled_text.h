#pragma once

#include <spawnfield/output_file.h>

#include <functional>
#include <string>
#include <string_view>

namespace spawnfield::cli {

/// A text that is kept until it is complete: the first 16 MB in memory, all of a longer one in a file without a name,
/// in the folder TMPDIR (default /tmp), which vanishes with the process.
class SpooledText {
public:
    SpooledText() = default;
    SpooledText(const SpooledText&) = delete;
    SpooledText& operator=(const SpooledText&) = delete;
    ~SpooledText();

    void add(std::string_view text);                                  ///< throws OutputError
    void pass_to(const std::function<void(std::string_view)>& sink);  ///< throws OutputError

private:
    void write_to_file();

    std::string waiting_;  ///< text that is not in the file
    int file_ = -1;        ///< a descriptor; -1: there is none
};

}  // namespace spawnfield::cli
