#include "output.h"

#include "interrupt.h"
#include "messages.h"
#include "streams.h"

#include <spawnfield/error.h>
#include <spawnfield/output_file.h>

#include <iostream>

namespace spawnfield::cli {

void write_output(const std::string& file,
                  const std::function<void(const std::function<void(std::string_view)>&)>& writer,
                  const std::function<void()>& then)
{
    clear_progress_bar();
    if (file.empty() || is_standard(file)) {
        writer([](std::string_view text) { std::cout << text; });
        std::cout.flush();
        if (!std::cout) throw OutputError("standard output", "cannot be written");
        then();
        return;
    }
    OutputFile out(file);
    writer([&](std::string_view text) {
        stop_if_interrupted();
        out.write(text);
    });
    out.flush();
    stop_if_interrupted();
    then();
    out.commit();
}

}  // namespace spawnfield::cli
