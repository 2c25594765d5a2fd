#pragma once

namespace spawnfield {

/// An axis-aligned rectangle, seen from above, m.
struct Rect {
    double low_x, low_y, high_x, high_y;

    double centre_x() const { return (low_x + high_x) / 2; }
    double centre_y() const { return (low_y + high_y) / 2; }
};

}  // namespace spawnfield
