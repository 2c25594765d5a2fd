#pragma once

#include "../../temp_folder.h"

#include <filesystem>
#include <functional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

/// The readers of files, for the fuzzer, and for the tests that read its seeds and its findings in every build.
namespace fuzz {

/// A reader, or several that read similar files. An input is a byte, which chooses one of `endings`, and then the
/// content of a file: 'a' is the first ending, 'b' the second one, and so on; all further bytes begin again with 'a'.
struct Reader {
    std::string name;
    std::vector<std::string> endings;  ///< of the names of files
    /// Reads a file. Throws FileError for a file that it refuses; any other exception is a finding. Throws
    /// std::logic_error for a result that is wrong.
    std::function<void(const std::filesystem::path&)> read;
    /// Names and contents of further files in the folder of the file.
    std::vector<std::pair<std::string, std::string>> neighbours = {};
};

/// Where readers find what they need.
struct Surroundings {
    std::filesystem::path source;   ///< root folder of this repository
    std::filesystem::path program;  ///< the program spawnfield, which reads scenes in a process of its own
};

/// Returns all readers.
std::vector<Reader> readers(const Surroundings& surroundings);

std::vector<Reader> text_readers();
std::vector<Reader> scene_readers();
std::vector<Reader> map_readers(const std::filesystem::path& source);
std::vector<Reader> apart_readers(const std::filesystem::path& program);

/// Returns the content of a kept graph that the reader `graphs` can use.
std::string graph_bytes(const std::filesystem::path& source);

/// Returns the input for a file with this ending. Throws std::out_of_range if the reader does not have it.
std::string input_of(const Reader& reader, const std::string& ending, std::string_view bytes);

/// Throws std::logic_error unless `is_right`: a reader returned a result that is wrong.
void require(bool is_right, const char* what);

/// A folder in which a reader reads one input after the other.
class Bench {
public:
    explicit Bench(const Reader& reader);

    /// Reads an input. Returns the message of a FileError; "" if the input was read. Throws std::logic_error if that
    /// message names no file of the folder, and if the reader left a file behind or removed one; and what the reader
    /// throws, except FileError.
    std::string run(std::string_view input) const;

private:
    std::size_t files() const;

    const Reader& reader_;
    TempFolder folder_;
};

/// An input that its reader must read without an error.
struct Seed {
    std::string reader, name, input;
};

/// Returns seeds for all readers, from the files of this repository and from texts.
std::vector<Seed> seeds(const std::vector<Reader>& readers, const std::filesystem::path& source);

}  // namespace fuzz
