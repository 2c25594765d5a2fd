#pragma once

#include <spawnfield/local_server.h>

/// The interface of the module src/serve: a shared library that contains all code that uses cpp-httplib, which needs
/// OpenSSL, and that is loaded when the first server starts.
namespace spawnfield::serve_module {

/// Does the work of serve_locally().
void serve(const LocalServerOptions& options);

/// The functions that the module exports.
struct Functions {
    static constexpr const char *module = "serve", *failure = "pages cannot be served";
    decltype(&serve) run;
};

}  // namespace spawnfield::serve_module
