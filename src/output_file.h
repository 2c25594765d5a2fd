#pragma once

#include <spawnfield/output_file.h>
