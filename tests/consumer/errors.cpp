// Catches the errors of the library's modules by their types, and prints them: errors DAMAGED_MESH. It is compiled with
// hidden symbols, so that it has its own copies of the types.
#include <spawnfield/error.h>
#include <spawnfield/heatmap.h>
#include <spawnfield/robot_picture.h>

#include <cstdio>

using namespace spawnfield;

template <class Error, class Call>
void expect(const Call& call)
{
    try {
        call();
        std::puts("no error");
    } catch (const Error& error) {
        std::puts(error.what());
    }
}

int main(int, char** argv)
try {
    expect<FileError>([&] { load_scene(argv[1]); });
    expect<ArgumentError>([] { write_heatmap({}, {}, {}, {.pixels = 199}, "a.png"); });
    expect<OutputError>([] { write_robot_picture(load_robot("box:1,1,1"), "missing/a.png"); });
} catch (const std::exception& error) {
    std::printf("another error: %s\n", error.what());
    return 1;
}
