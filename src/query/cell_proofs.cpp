#include "query/cell_proofs.h"

#include "base/intervals.h"
#include "free_space/footprint.h"
#include "robot/hull.h"

#include <cmath>
#include <stdexcept>

namespace spawnfield {
namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();
constexpr double slack = proof_slack;
constexpr std::size_t most_in_cluster = 12;

}  // namespace

struct CellProofs::Prism {
    Polygon2 polygon;
    double bottom, top;
};

/// The proofs about one cell.
class CellProofs::Cell {
public:
    Cell(const CellProofs& proofs, const Rect& rect)
        : proofs_(proofs), rect_(rect), facets_(proofs.shared_.map.geometry, rect)
    {
    }

    bool is_closed()
    {
        if (facets_.terrain.bottom > facets_.terrain.top) return true;
        find_bands();
        for (std::size_t b = 0; b < bands_.size(); ++b) {
            const Interval band = ground_in(bands_[b]);
            if (band.bottom > band.top || proofs_.area_.misses(rect_, {band.bottom, band.top}) || is_left_out(b))
                continue;
            if (!is_covered(band) && !is_submerged(b) && !is_blocked(band) && !is_in_ground(band) && !is_in_solid(band))
                return false;
        }
        return true;
    }

private:
    /// Computes the bands: intervals of heights, from the bottom up, that contain all layers of the cell.
    void find_bands()
    {
        if (facets_.has_too_many) {
            bands_.push_back(facets_.terrain);
            return;
        }
        drop_lower_ends();
        for (const Facet& facet : facets_.all)
            if (facet.terrain) bands_.push_back(facet.z);
        join_intervals(bands_, 2 * layer_tolerance);
    }

    /// Excludes lower ends, which are not layers: there, a line that goes down leaves a filled mesh. Faces whose
    /// heights overlap form a cluster. Between two clusters, the cell is completely inside the mesh or completely
    /// outside, like its centre.
    void drop_lower_ends()
    {
        std::vector<Facet*> filled;
        for (Facet& facet : facets_.all)
            if (facet.filled && !facet.water) filled.push_back(&facet);
        std::sort(filled.begin(), filled.end(), [](const Facet* l, const Facet* r) {
            return l->piece != r->piece ? l->piece < r->piece : l->z.top > r->z.top;
        });
        for (std::size_t i = 0; i < filled.size();) {
            const std::uint32_t piece = filled[i]->piece;
            std::size_t above = 0;  // crossings of the line through the centre, so far
            while (i < filled.size() && filled[i]->piece == piece) {
                std::vector<Facet*> cluster;
                for (double bottom = filled[i]->z.bottom;
                     i < filled.size() && filled[i]->piece == piece && filled[i]->z.top >= bottom; ++i) {
                    cluster.push_back(filled[i]);
                    bottom = std::min(bottom, filled[i]->z.bottom);
                }
                const bool is_inside_above = above % 2 == 1 && !cluster[0]->open;
                for (const Facet* facet : cluster) above += facet->crossed;
                if (is_inside_above && is_single(cluster))
                    for (Facet* facet : cluster) facet->terrain = false;
                else
                    for (Facet* facet : cluster) facet->terrain = facet->terrain && facet->has_plane;
            }
        }
    }

    /// Returns whether each vertical line crosses the cluster at most once.
    static bool is_single(const std::vector<Facet*>& cluster)
    {
        if (cluster.size() > most_in_cluster) return false;
        for (std::size_t i = 0; i < cluster.size(); ++i) {
            if (!cluster[i]->has_plane) return false;
            for (std::size_t j = 0; j < i; ++j)
                if (!are_parted(cluster[i]->polygon, cluster[j]->polygon, slack)) return false;
        }
        return true;
    }

    template <class Test>
    bool covers(const std::vector<Facet>& facets, const Rect& rect, const Test& test) const
    {
        Remainder remainder(rect);
        for (const Facet& facet : facets) {
            if (facet.polygon.empty() || !test(facet)) continue;
            remainder.take(facet.polygon);
            if (remainder.is_empty()) return true;
            if (remainder.is_hopeless()) return false;
        }
        return false;
    }

    /// Returns the part of a band whose layers are ground and whose poses are not outside.
    Interval ground_in(const Interval& band) const
    {
        return {std::max(band.bottom, proofs_.ground_z_.low - slack),
                std::min(band.top, proofs_.ground_z_.high + slack)};
    }

    /// Returns whether the band is not chosen, because only the top layer is chosen and the whole cell has a higher
    /// layer that is ground.
    bool is_left_out(std::size_t b) const
    {
        const LayerChoice& layers = proofs_.options_.layers;
        const bool only_top = layers.kind == LayerChoice::Kind::Top ||
                              (layers.kind == LayerChoice::Kind::Index && layers.index == 0);
        if (!only_top || facets_.has_too_many || b + 1 == bands_.size()) return false;
        return covers(facets_.all, rect_, [&](const Facet& facet) {
            return facet.terrain && !facet.filled && facet.z.bottom > bands_[b].top + 2 * layer_tolerance &&
                   facet.z.bottom >= proofs_.layer_z_.low && facet.z.top <= proofs_.layer_z_.high;
        });
    }

    bool is_covered(const Interval& band) const
    {
        const std::vector<SpacedPoints>& avoided = proofs_.avoided_.grids();
        return is_covered(band, proofs_.taken_) ||
               std::any_of(avoided.begin(), avoided.end(),
                           [&](const SpacedPoints& points) { return is_covered(band, points); });
    }

    /// Returns whether all poses of the band are too near to one and the same point.
    bool is_covered(const Interval& band, const SpacedPoints& points) const
    {
        const double distance = points.distance();
        if (!(distance > 0)) return false;
        const double offset = proofs_.offset_, low = band.bottom + offset, high = band.top + offset;
        const Vec3 middle(rect_.centre_x(), rect_.centre_y(), (low + high) / 2);
        const Vec3 half((rect_.high_x - rect_.low_x) / 2, (rect_.high_y - rect_.low_y) / 2, (high - low) / 2);
        if (half.norm() >= distance) return false;
        return points.any_near(
            middle, [&](const Vec3& other) { return ((other - middle).cwiseAbs() + half).norm() < distance - slack; });
    }

    bool is_submerged(std::size_t b) const
    {
        const Interval& band = bands_[b];
        const double max_water_depth = proofs_.shared_.options.max_water_depth;
        const bool any_depth = std::isinf(max_water_depth);
        // All terrain that may be the ground of a pose must be under water: its layer, and the layers between that
        // layer and the origin.
        double highest = band.top;
        for (std::size_t above = b + 1;
             above < bands_.size() && bands_[above].bottom <= band.top + proofs_.offset_ + slack; ++above)
            highest = bands_[above].top;
        if (facets_.has_too_many || (!any_depth && proofs_.offset_ < 0)) return false;
        return covers(facets_.all, rect_, [&](const Facet& facet) {
            if (!facet.water || facet.z.bottom < highest) return false;
            return any_depth || (!facet.filled && facet.z.top <= band.bottom + max_water_depth);
        });
    }

    bool is_blocked(const Interval& band) const
    {
        const Pose pose{{rect_.centre_x(), rect_.centre_y(), (band.bottom + band.top) / 2 + proofs_.offset_},
                        Mat3::Identity()};
        for (const Eroded& eroded : proofs_.eroded_)  // the largest robot comes first
            if ((band.top - band.bottom) / 2 <= eroded.half_height) return !eroded.checker.is_free(pose);
        return false;
    }

    /// Returns whether some point inside the robot is in the same solid at all poses of the band.
    bool is_in_solid(const Interval& band) const
    {
        return std::any_of(proofs_.prisms_.begin(), proofs_.prisms_.end(), [&](const Prism& prism) {
            const Vec2 shift = (prism.polygon[0] + prism.polygon[prism.polygon.size() / 2]) / 2;
            const double rise = proofs_.offset_ + (prism.bottom + prism.top) / 2;
            return is_solid(
                {rect_.low_x + shift.x(), rect_.low_y + shift.y(), rect_.high_x + shift.x(), rect_.high_y + shift.y()},
                {band.bottom + rise - slack, band.top + rise + slack});
        });
    }

    /// Returns whether one solid contains the whole block. A convex shape does if it contains the vertical edges of the
    /// block. A mesh does if it contains the vertical line through the centre, and if the block meets no surface.
    bool is_solid(const Rect& rect, const Interval& z) const
    {
        const auto holds = [&](const Interval& span) { return span.bottom <= z.bottom && span.top >= z.top; };
        bool in_primitive = false, meets_other = false;
        proofs_.shared_.map.geometry.impl().visit_in(rect, [&](const Tile& tile, std::uint32_t element) {
            const ElementBox box = tile.box(element);
            const Label label = tile.label(element);
            if (in_primitive || label == Label::Water || box.min[2] > z.top || box.max[2] < z.bottom) return;
            meets_other = true;
            if (tile.is_triangle(element)) return;
            const Shape shape = tile.primitive(element).shape();
            const SmallPolygon corners = corners_of(rect);
            in_primitive = std::all_of(corners.begin(), corners.end(), [&](const Vec2& p) {
                const auto span = vertical_interval(shape, p.x(), p.y());
                return span && holds(*span);
            });
        });
        if (in_primitive || meets_other) return in_primitive;
        const Column column = column_at(proofs_.shared_.map.geometry, rect.centre_x(), rect.centre_y());
        return std::any_of(column.spans.begin(), column.spans.end(), [&](const Span& span) {
            return span.sealed && holds({span.bottom, span.top});
        });
    }

    /// Returns whether a terrain surface passes through the robot at all poses of the band. Examines some vertical
    /// lines of each prism, one after the other.
    bool is_in_ground(const Interval& band) const
    {
        if (facets_.has_too_many) return false;
        std::vector<const Facet*> stands;
        for (const Facet& facet : facets_.all)
            if (facet.terrain && facet.z.bottom <= band.top && facet.z.top >= band.bottom) stands.push_back(&facet);
        if (stands.size() > most_in_cluster) return false;
        for (const Facet* facet : stands)
            if (!facet->has_plane) return false;
        for (const Prism& prism : proofs_.prisms_) {
            const std::size_t stride = std::max<std::size_t>(1, prism.polygon.size() / 8);
            for (std::size_t k = 0; k < prism.polygon.size(); k += stride)
                if (meets_ground(stands, prism.polygon[k], prism)) return true;
        }
        return false;
    }

    bool meets_ground(const std::vector<const Facet*>& stands, const Vec2& shift, const Prism& prism) const
    {
        const Rect there{rect_.low_x + shift.x(), rect_.low_y + shift.y(), rect_.high_x + shift.x(),
                         rect_.high_y + shift.y()};
        const CellFacets ground(proofs_.shared_.map.geometry, there);
        if (ground.has_too_many) return false;
        const double low = proofs_.offset_ + prism.bottom + slack, high = proofs_.offset_ + prism.top - slack;
        return covers(ground.all, there, [&](const Facet& facet) {
            return facet.terrain && facet.has_plane &&
                   std::all_of(stands.begin(), stands.end(), [&](const Facet* stand) {
                       const Interval rise = rise_between(*stand, facet, shift);
                       return rise.bottom >= low && rise.top <= high;
                   });
        });
    }

    /// Returns how much higher `to` is at (x, y) + shift than `from` is at (x, y), for all (x, y) of the cell where
    /// both exist. If there are none, bottom > top.
    Interval rise_between(const Facet& from, const Facet& to, const Vec2& shift) const
    {
        Vec2 low(rect_.low_x, rect_.low_y), high(rect_.high_x, rect_.high_y);
        const auto narrow = [&](const SmallPolygon& polygon, const Vec2& by) {
            Vec2 least(infinity, infinity), most(-infinity, -infinity);
            for (const Vec2& p : polygon) {
                least = least.cwiseMin(p - by);
                most = most.cwiseMax(p - by);
            }
            low = low.cwiseMax(least - Vec2::Constant(slack));
            high = high.cwiseMin(most + Vec2::Constant(slack));
        };
        narrow(from.polygon, Vec2::Zero());
        narrow(to.polygon, shift);
        if (low.x() > high.x() || low.y() > high.y()) return {infinity, -infinity};
        const Vec2 middle = (low + high) / 2, half = (high - low) / 2;
        const double rise = to.at(middle.x() + shift.x(), middle.y() + shift.y()) - from.at(middle.x(), middle.y());
        const double reach = (to.slope - from.slope).cwiseAbs().dot(half);
        return {rise - reach, rise + reach};
    }

    const CellProofs& proofs_;
    const Rect rect_;
    CellFacets facets_;
    std::vector<Interval> bands_;
};

CellProofs::CellProofs(const Judge::Impl& shared, const SampleOptions& options, const AreaIndex& area,
                       const SpacedPoints& taken, const AvoidIndex& avoided)
    : shared_(shared), options_(options), offset_(*options.offset),
      ground_z_(overlap(overlap(shared.map.z_limits, options.z),
                        ZRange{shared.map.z_limits.low - offset_, shared.map.z_limits.high - offset_})),
      layer_z_(overlap(shared.map.z_limits, options.z)), area_(area), taken_(taken), avoided_(avoided)
{
    if (shared.options.obstacles != Obstacles::Geometry) return;  // the proofs use the geometry, not the voxels
    const std::vector<Footprint> prints = options.random_yaw
                                              ? yaw_free_footprints(shared.robot)
                                              : footprints(shared.robot, rotation_from_rpy(0, 0, options.yaw), true);
    for (const Footprint& print : prints)
        if (!print.inner.polygon.empty()) prisms_.push_back({print.inner.polygon, print.inner.bottom, print.inner.top});
}

CellProofs::~CellProofs() = default;

void CellProofs::set_half_cell(double half_x, double half_y)
{
    eroded_.clear();
    for (const double share : {0.01, 0.1, 0.4, 1.0}) {
        const double half_height = share * std::max(half_x, half_y) + slack;
        Robot robot = eroded(half_x, half_y, half_height);
        if (!robot.parts.empty()) eroded_.push_back({half_height, CollisionChecker(shared_.map.geometry, robot)});
    }
}

/// Returns a robot that stays inside the real robot when it is moved by up to these lengths.
Robot CellProofs::eroded(double half_x, double half_y, double half_height) const
{
    Robot robot;
    robot.name = "eroded";
    for (const Prism& prism : prisms_) {
        Polygon2 rest = prism.polygon;
        for (std::size_t k = 0; k < prism.polygon.size() && !rest.empty(); ++k) {
            const Vec2 &p = prism.polygon[k], &q = prism.polygon[(k + 1) % prism.polygon.size()];
            const Vec2 normal = unit_edge_normal(p, q);
            rest = cut(rest, normal,
                       normal.dot(p) - half_x * std::abs(normal.x()) - half_y * std::abs(normal.y()) - slack);
        }
        const double bottom = prism.bottom + half_height, top = prism.top - half_height;
        constexpr double least = 1e-3;  // m; flatter or narrower parts would prove little
        rest = convex_hull(std::move(rest));
        if (rest.size() < 3 || area_of(rest) < least * least || !(top - bottom > least)) continue;
        std::vector<Vec3> corners;
        for (const Vec2& p : rest) {
            corners.emplace_back(p.x(), p.y(), bottom);
            corners.emplace_back(p.x(), p.y(), top);
        }
        try {
            robot.parts.push_back(convex_hull(corners));
        } catch (const std::domain_error&) {
            continue;  // the part is too thin for a hull, so it is left out
        }
    }
    return robot;
}

bool CellProofs::is_closed(const Rect& cell) const { return area_.misses(cell) || Cell(*this, cell).is_closed(); }

}  // namespace spawnfield
