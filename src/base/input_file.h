#pragma once

#include <spawnfield/input_file.h>
