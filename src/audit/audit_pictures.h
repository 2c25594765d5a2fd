#pragma once

#include <spawnfield/audit.h>

namespace spawnfield {

/// Pictures of what a robot can do in a world, as the bytes of PNG files.
struct AuditPictures {
    std::string heatmap, islands;
};

/// Draws the raster of a robot with the start poses, and its islands. Throws OutputError if the temporary folder cannot
/// be written.
AuditPictures draw_audit(const AuditReport& report, const RobotAudit& robot, int threads);

}  // namespace spawnfield
