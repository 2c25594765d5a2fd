#include "output.h"

#include "host.h"
#include "messages.h"
#include "spooled_text.h"
#include "streams.h"

#include <spawnfield/output_file.h>

namespace spawnfield::cli {

void write_output(const CommonArgs& args, const std::string& file,
                  const std::function<void(const std::function<void(std::string_view)>&)>& writer,
                  const std::function<void()>& then)
{
    clear_progress_bar(args);
    if (file.empty() || is_standard(file)) {
        if (args.host->wants_text()) {
            SpooledText whole;
            writer([&](std::string_view text) {
                stop_if_interrupted(args);
                whole.add(text);
            });
            whole.pass_to([&](std::string_view text) { args.host->write(text); });
        }
        args.host->flush();
        then();
        return;
    }
    OutputFile out(file);
    writer([&](std::string_view text) {
        stop_if_interrupted(args);
        out.write(text);
    });
    out.flush();
    stop_if_interrupted(args);
    then();
    out.commit();
}

}  // namespace spawnfield::cli
