#include "base/module.h"
#include "review/serve_module.h"

namespace spawnfield {

void serve_locally(const LocalServerOptions& options) { module_functions<serve_module::Functions>().run(options); }

}  // namespace spawnfield
