#pragma once

#include "query_args.h"

#include <functional>
#include <memory>
#include <string>

namespace spawnfield::cli {

/// What `review --serve` keeps while its page is open.
struct LiveReview {
    const QueryArgs& args;    ///< args.map and args.robot are the names of the two below
    const CLI::App& command;  ///< `review`, whose options are the first values of the page's controls
    std::shared_ptr<const Map> map;
    std::shared_ptr<const Robot> robot;
    /// Returns the page. Its argument is the value of `live` in its data (docs/review-format.md).
    std::function<std::string(const std::string& live)> page;
    int port = 0;  ///< 0: any
};

/// Serves the page until Ctrl-C. Its queries run as commands of this program, with the map and the robot in memory.
void serve_review(const LiveReview& review);

}  // namespace spawnfield::cli
