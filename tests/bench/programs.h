#pragma once

#include "targets.h"

namespace bench {

using OnRow = std::function<void(TargetRow)>;

/// Measures the rows of whole programs, which run as separate processes on maps in a temporary folder. Must run while
/// this process is still small (see ProcessRun::peak_memory).
void measure_programs(const TargetOptions& options, const OnRow& on_row);

}  // namespace bench
