#pragma once

#include "geometry/tile_tree.h"
#include "settle/convex.h"

#include <spawnfield/place_rules.h>

#include <optional>
#include <vector>

namespace spawnfield {

struct Forest;

/// Measures distances to some parts and faces of a scene: to their triangles and solid shapes. Const calls may run at
/// the same time.
class PartsNear {
public:
    /// Reads all tiles of the geometry. Throws FileError for a damaged one.
    PartsNear(const Geometry& geometry, const Selection& parts);

    /// Returns the shortest way from one of the bodies to the parts, m. Returns nothing if it is longer than `most`
    /// (may be infinite). The bodies are relative to `position`, and must lie near it.
    std::optional<Vec3> way_from(const std::vector<Convex>& bodies, const Vec3& position, double most) const;

    /// Returns the boxes of all triangles and solid shapes of the parts, slightly widened.
    const std::vector<ElementBox>& boxes() const { return tree_.boxes(); }

private:
    struct Element {
        const Forest* forest;  ///< one of geometry_
        std::uint32_t tree, tile, element;
        ElementBox box;
    };
    static std::vector<Element> elements_of(const Geometry& geometry, const Selection& parts);
    static std::vector<ElementBox> boxes_of(const std::vector<Element>& elements);

    Geometry geometry_;
    std::vector<Element> elements_;  ///< in packed order
    TileTree tree_;                  ///< of their boxes
    Bounds bounds_;                  ///< of all of them
};

}  // namespace spawnfield
