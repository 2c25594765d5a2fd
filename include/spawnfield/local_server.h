#pragma once

#include <spawnfield/export.h>

#include <functional>
#include <string>

namespace spawnfield {

struct WebRequest {
    std::string method;  ///< "GET" or "POST"
    std::string path;    ///< below the server's address; empty: the address itself
    std::string body;
};

struct WebAnswer {
    int status = 200;
    std::string type = "application/json";
    std::string body;
};

struct LocalServerOptions {
    int port = 0;  ///< 0: any free one
    /// Answers a request; called by one thread at a time.
    std::function<WebAnswer(const WebRequest&)> answer;
    /// Called when the server is ready, with its address: http://127.0.0.1:PORT/TOKEN/
    std::function<void(const std::string& address)> on_start;
    /// Asked ten times in a second; the server ends when it returns true.
    std::function<bool()> stop;
};

/// Serves HTTP/1.1 on the loopback address until stop() returns true. The address has a random token of 128 bits; all
/// requests without it, from pages of other origins, for other hosts, or with more than 1 MB are refused, without a
/// call of answer(). Throws std::runtime_error if the port is used already.
SPAWNFIELD_API void serve_locally(const LocalServerOptions& options);

}  // namespace spawnfield
