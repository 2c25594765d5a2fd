#include "reader.h"

#include <spawnfield/error.h>

#include <algorithm>
#include <iterator>
#include <stdexcept>

namespace fuzz {
namespace {

namespace fs = std::filesystem;

constexpr unsigned char first_ending = 'a';

}  // namespace

std::vector<Reader> readers(const Surroundings& surroundings)
{
    std::vector<Reader> all = text_readers();
    for (std::vector<Reader> more :
         {scene_readers(), map_readers(surroundings.source), apart_readers(surroundings.program)})
        std::move(more.begin(), more.end(), std::back_inserter(all));
    return all;
}

std::string input_of(const Reader& reader, const std::string& ending, std::string_view bytes)
{
    const auto found = std::find(reader.endings.begin(), reader.endings.end(), ending);
    if (found == reader.endings.end()) throw std::out_of_range(reader.name + " reads no files that end in " + ending);
    return char(first_ending + (found - reader.endings.begin())) + std::string(bytes);
}

void require(bool is_right, const char* what)
{
    if (!is_right) throw std::logic_error(what);
}

Bench::Bench(const Reader& reader) : reader_(reader)
{
    for (const auto& [name, bytes] : reader.neighbours) folder_.write(name, bytes);
}

std::string Bench::run(std::string_view input) const
{
    if (input.empty()) return "";
    const auto choice = static_cast<unsigned char>(static_cast<unsigned char>(input[0]) - first_ending);
    const fs::path file = folder_.write("input" + reader_.endings[choice % reader_.endings.size()], input.substr(1));
    const std::size_t before = files();
    std::string message;
    try {
        reader_.read(file);
    } catch (const spawnfield::FileError& error) {
        message = error.what();
        if (message.find(folder_.path().string()) == std::string::npos)
            throw std::logic_error("the message names no file: " + message);
    }
    require(files() == before, "the number of files in the folder differs after reading");
    fs::remove(file);
    return message;
}

std::size_t Bench::files() const
{
    return std::size_t(std::distance(fs::recursive_directory_iterator(folder_.path()), {}));
}

}  // namespace fuzz
