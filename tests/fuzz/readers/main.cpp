#include "reader.h"

#include <algorithm>
#include <cctype>
#include <cstdlib>
#include <iostream>
#include <optional>
#include <set>

// The fuzzer (libFuzzer). Its options begin with one dash, ours with two:
//   --reader=NAME          the reader that gets the inputs
//   --program=FILE         the program spawnfield that reads files in a process of its own
//   --write-seeds=FOLDER   instead: write the seeds and a dictionary of each reader to FOLDER, and print their names
//   --more=FOLDER          with it: also all files of this folder with the right endings, of at most 64 kB

// assimp leaks memory when it rejects a damaged file.
extern "C" const char* __lsan_default_suppressions() { return "leak:libassimp"; }

namespace {

namespace fs = std::filesystem;

struct Arguments {
    std::string reader, seeds, more;
    fuzz::Surroundings surroundings{SPAWNFIELD_SOURCE, {}};
};

Arguments parsed(int argc, char** argv)
{
    Arguments out;
    const auto take = [](const std::string& text, const std::string& option, auto& value) {
        if (text.starts_with(option + "=")) value = text.substr(option.size() + 1);
    };
    for (int k = 1; k < argc; ++k) {
        take(argv[k], "--reader", out.reader);
        take(argv[k], "--program", out.surroundings.program);
        take(argv[k], "--write-seeds", out.seeds);
        take(argv[k], "--more", out.more);
    }
    return out;
}

/// Returns the dictionary of libFuzzer for some inputs: the words of texts, and numbers that are often mistakes.
std::string dictionary_of(const std::vector<std::string>& inputs)
{
    std::set<std::string> words{"-1",  "0",   "1e308",      "1e-308",     "1e19",       "65536",
                                "nan", "inf", "4294967295", "2147483648", "0x7fffffff", "9007199254740993"};
    for (const std::string& input : inputs) {
        std::string word;
        for (const char c : input + " ") {
            if (std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '_' || c == ':') {
                word += c;
                continue;
            }
            if (word.size() > 2 && word.size() < 25 && std::isalpha(static_cast<unsigned char>(word[0])) != 0)
                words.insert(word);
            word.clear();
        }
    }
    std::string out;
    for (const std::string& word : words) out += "\"" + word + "\"\n";
    return out + "\"\\xff\\xff\\xff\\xff\"\n\"\\xff\\xff\\xff\\x7f\"\n\"\\x00\\x00\\x00\\x80\"\n";
}

void write(const fs::path& file, std::string_view bytes)
{
    fs::create_directories(file.parent_path());
    std::ofstream(file, std::ios::binary) << bytes;
}

/// Returns the inputs for all files below a folder that a reader reads.
std::vector<std::string> inputs_below(const fs::path& folder, const fuzz::Reader& reader)
{
    std::vector<fs::path> files;
    for (const auto& entry : fs::recursive_directory_iterator(folder))
        if (entry.is_regular_file() && entry.file_size() <= 1 << 16) files.push_back(entry.path());
    std::sort(files.begin(), files.end());
    std::vector<std::string> out;
    for (const fs::path& file : files) {
        const std::string ending = file.extension().string();
        if (std::find(reader.endings.begin(), reader.endings.end(), ending) != reader.endings.end())
            out.push_back(fuzz::input_of(reader, ending, bytes_of(file)));
    }
    return out;
}

void write_seeds(const Arguments& args)
{
    const std::vector<fuzz::Reader> readers = fuzz::readers(args.surroundings);
    const std::vector<fuzz::Seed> seeds = fuzz::seeds(readers, args.surroundings.source);
    for (const fuzz::Reader& reader : readers) {
        const fs::path folder = fs::path(args.seeds) / reader.name;
        fs::create_directories(folder);
        std::vector<std::string> inputs;
        if (!args.more.empty()) inputs = inputs_below(args.more, reader);
        for (const fuzz::Seed& seed : seeds)
            if (seed.reader == reader.name) inputs.push_back(seed.input);
        for (std::size_t k = 0; k < inputs.size(); ++k) write(folder / ("seed-" + std::to_string(k)), inputs[k]);
        write(fs::path(args.seeds) / (reader.name + ".dict"), dictionary_of(inputs));
        std::cout << reader.name << "\n";
    }
}

const fuzz::Bench* bench = nullptr;

}  // namespace

extern "C" int LLVMFuzzerInitialize(int* argc, char*** argv)
{
    const Arguments args = parsed(*argc, *argv);
    if (!args.seeds.empty()) {
        write_seeds(args);
        std::exit(0);
    }
    static const std::vector<fuzz::Reader> readers = fuzz::readers(args.surroundings);
    const auto reader = std::find_if(readers.begin(), readers.end(),
                                     [&](const fuzz::Reader& known) { return known.name == args.reader; });
    if (reader == readers.end()) {
        std::cerr << "--reader=" << args.reader << ": there is no such reader; --write-seeds=FOLDER prints all\n";
        std::exit(2);
    }
    static const fuzz::Bench used(*reader);
    bench = &used;
    return 0;
}

extern "C" int LLVMFuzzerTestOneInput(const unsigned char* data, std::size_t size)
{
    bench->run({reinterpret_cast<const char*>(data), size});
    return 0;
}
