#pragma once

#include "base/rect.h"
#include "collision/tile_bins.h"

namespace spawnfield {

/// Finds the tiles of a geometry near one robot after the other. It keeps the tiles near the last robot, and those of a
/// rectangle, if the caller knows that the next robots are in it.
class NearTiles {
public:
    /// The geometry must live as long as this object.
    explicit NearTiles(const Geometry::Impl& geometry) : near_last_(geometry), in_expected_(geometry) {}

    /// Says that the boxes around the next robots lie in this rectangle. There should be many of them, because the
    /// first one finds all tiles of the rectangle. Boxes beyond it are found, too.
    void expect(const Rect& area);

    /// Calls visit(tile) for each tile that meets a box, until it returns false.
    template <class Visit>
    void visit(const Bounds& space, const Visit& visit)
    {
        tiles_around(space).visit(space, visit);
    }

private:
    TileBins& tiles_around(const Bounds& space);

    Bounds last_;         ///< the last box beyond the expected rectangle
    TileBins near_last_;  ///< around it
    Bounds expected_;     ///< the rectangle, infinite along z; empty if there is none
    bool is_found_ = false;
    TileBins in_expected_;  ///< of that rectangle, if they were found
};

}  // namespace spawnfield
