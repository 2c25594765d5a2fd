#include "base/module.h"
#include "review/serve_module.h"

SPAWNFIELD_MODULE(serve, &spawnfield::serve_module::serve);
