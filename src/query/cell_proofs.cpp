#include "query/cell_proofs.h"

#include "column/surface_hit.h"
#include "free_space/footprint.h"
#include "geometry/tile.h"
#include "robot/hull.h"

#include <Eigen/Geometry>

#include <cmath>
#include <stdexcept>

namespace spawnfield {
namespace {

constexpr double inf = std::numeric_limits<double>::infinity();
constexpr double slack = 1e-8;            // m that heights and distances are held away from their limits
constexpr std::size_t most_facets = 64;   // in a cell; beyond them only their heights count
constexpr std::size_t most_in_cluster = 12;

/// A convex polygon of few corners, counterclockwise, without memory of its own.
class SmallPolygon {
public:
    static constexpr std::size_t most = 15;

    SmallPolygon() = default;
    SmallPolygon(std::initializer_list<Vec2> corners)
    {
        for (const Vec2& p : corners) push_back(p);
    }
    std::size_t size() const { return size_; }
    bool empty() const { return size_ == 0; }
    const Vec2& operator[](std::size_t k) const { return corners_[k]; }
    const Vec2* begin() const { return corners_.data(); }
    const Vec2* end() const { return corners_.data() + size_; }
    void push_back(const Vec2& p) { corners_[size_++] = p; }
    void turn_round() { std::reverse(corners_.begin(), corners_.begin() + std::ptrdiff_t(size_)); }

private:
    std::array<Vec2, most> corners_;
    std::size_t size_ = 0;
};

/// Unit normal of the edge from p to q of a counterclockwise polygon, outwards.
Vec2 outward(const Vec2& p, const Vec2& q) { return normal_of(p, q).normalized(); }

/// Narrower than lines are told apart.
bool is_sliver(const SmallPolygon& polygon)
{
    double longest = 0;
    for (const Vec2& p : polygon) longest = std::max(longest, (p - polygon[0]).norm());
    return polygon.size() < 3 || area_of(polygon) <= touch_tolerance / 4 * longest;
}

SmallPolygon corners_of(const Rect& r) { return {{r.low_x, r.low_y}, {r.high_x, r.low_y}, {r.high_x, r.high_y}, {r.low_x, r.high_y}}; }

/// What is left of a rectangle when convex polygons are taken away.
class Remainder {
public:
    explicit Remainder(const Rect& rect) : left_{corners_of(rect)} {}

    void take(const SmallPolygon& polygon)
    {
        out_.clear();
        for (SmallPolygon& piece : left_) {
            if (piece.size() + polygon.size() > SmallPolygon::most) {  // a piece of a piece of a piece: may well stay
                out_.push_back(piece);
                continue;
            }
            for (std::size_t k = 0; k < polygon.size() && !piece.empty(); ++k) {
                const Vec2 &p = polygon[k], &q = polygon[(k + 1) % polygon.size()];
                const Vec2 normal = outward(p, q);
                const SmallPolygon beyond = cut(piece, -normal, -normal.dot(p));
                if (!is_sliver(beyond)) out_.push_back(beyond);
                piece = cut(piece, normal, normal.dot(p));
            }
        }
        std::swap(left_, out_);
    }
    bool is_empty() const { return left_.empty(); }
    bool is_hopeless() const { return left_.size() > 64; }

private:
    std::vector<SmallPolygon> left_, out_;
};

/// Whether some edge of one has the other beyond it, but for `by` m.
bool are_parted(const SmallPolygon& a, const SmallPolygon& b, double by)
{
    const auto parts = [&](const SmallPolygon& from, const SmallPolygon& other) {
        for (std::size_t k = 0; k < from.size(); ++k) {
            const Vec2 normal = outward(from[k], from[k + 1 < from.size() ? k + 1 : 0]);
            const double rim = normal.dot(from[k]) - by;
            if (std::all_of(other.begin(), other.end(), [&](const Vec2& p) { return normal.dot(p) >= rim; })) return true;
        }
        return false;
    };
    return parts(a, b) || parts(b, a);
}

}  // namespace

struct CellProofs::Prism {
    Polygon2 polygon;
    double bottom, top;
};

/// A flat piece of surface, or of what a primitive has above; its plane is height + slope * (x, y).
struct CellProofs::Facet {
    SmallPolygon polygon;  ///< seen from above; empty: upright, or not known
    Interval z;           ///< within the cell, m
    double height = 0;
    Vec2 slope = Vec2::Zero();
    bool has_plane = false;
    bool terrain = false, water = false;
    bool filled = false;  ///< of a filled mesh: only some crossings are upper ends
    bool open = false;
    bool crossed = false;  ///< by the line through the cell's centre
    std::uint32_t piece = 0;

    double at(double x, double y) const { return height + slope.x() * x + slope.y() * y; }
};

/// What there is in a cell.
struct CellProofs::Facets {
    std::vector<Facet> all;
    bool has_too_many = false;
    Interval terrain{inf, -inf};  ///< heights of all terrain

    Facets(const Geometry& geometry, const Rect& cell) : cell_(cell), corners_(corners_of(cell))
    {
        geometry.impl().visit_in(cell.low_x, cell.low_y, cell.high_x, cell.high_y, [&](const Tile& tile, std::uint32_t element) {
            const ElementBox& box = tile.boxes[element];
            if (tile.label(element) == Label::Terrain) {
                terrain.bottom = std::min(terrain.bottom, double(box.min[2]));
                terrain.top = std::max(terrain.top, double(box.max[2]));
            }
            has_too_many = has_too_many || all.size() >= most_facets;
            if (has_too_many) return;
            if (tile.is_triangle(element)) add_triangle(tile, element, false);
            else add_primitive(tile, element);
        });
        if (has_too_many || !has_filled_terrain_) return;
        // Crossings of the same mesh that are no terrain count where inside and outside are told apart.
        geometry.impl().visit_in(cell.low_x, cell.low_y, cell.high_x, cell.high_y, [&](const Tile& tile, std::uint32_t element) {
            has_too_many = has_too_many || all.size() >= most_facets;
            if (tile.is_triangle(element) && !has_too_many) add_triangle(tile, element, true);
        });
    }

private:
    void set_plane(const Vec3& a, const Vec3& normal, const Interval& limits, Facet& out) const
    {
        out.has_plane = true;
        out.slope = Vec2(-normal.x() / normal.z(), -normal.y() / normal.z());
        out.height = a.z() - out.slope.dot(a.head<2>());
        Vec2 low(inf, inf), high(-inf, -inf);
        for (const Vec2& p : out.polygon) {
            low = low.cwiseMin(p);
            high = high.cwiseMax(p);
        }
        low = low.cwiseMax(Vec2(cell_.low_x, cell_.low_y));
        high = high.cwiseMin(Vec2(cell_.high_x, cell_.high_y));
        const Vec2 middle = (low + high) / 2, half = ((high - low) / 2).cwiseMax(0.0);
        const double z = a.z() + out.slope.dot(middle - a.head<2>()), reach = out.slope.cwiseAbs().dot(half);
        out.z = {std::clamp(z - reach, limits.bottom, limits.top) - slack, std::clamp(z + reach, limits.bottom, limits.top) + slack};
    }

    void add_triangle(const Tile& tile, std::uint32_t element, bool other_filled)
    {
        if (other_filled && (tile.label(element) == Label::Terrain || tile.label(element) == Label::Water)) return;
        const auto [a, b, c] = tile.corners(element);
        const TileTriangle& triangle = tile.triangles[element];
        const TilePiece& piece = tile.pieces[triangle.piece];
        Facet out;
        out.filled = piece.solid != 0;
        out.open = piece.open != 0;
        out.piece = piece.piece;
        const Vec3 normal = (b - a).cross(c - a);
        out.water = triangle.label == Label::Water;
        out.terrain = triangle.label == Label::Terrain && (piece.sides_up == 0 || out.filled || normal.z() > 0);
        if (!out.terrain && !out.water && !(other_filled && out.filled)) return;
        has_filled_terrain_ = has_filled_terrain_ || (out.filled && out.terrain);
        const Interval limits{std::min({a.z(), b.z(), c.z()}), std::max({a.z(), b.z(), c.z()})};
        const double longest = std::max({(b - a).head<2>().norm(), (c - a).head<2>().norm(), (c - b).head<2>().norm()});
        if (std::abs(normal.z()) <= touch_tolerance * longest) {
            if (!out.filled) return;  // a sheet seen edge-on gives nothing
            out.z = limits;
            all.push_back(std::move(out));
            return;
        }
        out.polygon = {a.head<2>(), b.head<2>(), c.head<2>()};
        if (normal.z() < 0) out.polygon.turn_round();
        if (are_parted(corners_, out.polygon, -4 * touch_tolerance)) return;
        set_plane(a, normal, limits, out);
        if (out.filled) {
            const auto hit = SeenTriangle(tile, element).hit(cell_.centre_x(), cell_.centre_y());
            out.crossed = hit && hit->crosses;
        }
        all.push_back(std::move(out));
    }

    void add_primitive(const Tile& tile, std::uint32_t element)
    {
        const Label label = tile.label(element);
        if (label != Label::Terrain && label != Label::Water) return;
        const Shape shape = tile.primitive(element).shape();
        if (shape.kind == ShapeKind::Box) {
            add_box(shape, label);
            return;
        }
        Facet out;
        out.terrain = label == Label::Terrain;
        out.water = label == Label::Water;
        const ElementBox& box = tile.boxes[element];
        out.z = {double(box.min[2]), double(box.max[2])};
        // The upper surface of a convex body is concave: least at a corner, and below the point mirror image of that.
        double least = inf;
        const auto middle = vertical_interval(shape, cell_.centre_x(), cell_.centre_y());
        bool is_whole = middle.has_value();
        for (const Vec2& corner : corners_of(cell_)) {
            const auto there = vertical_interval(shape, corner.x(), corner.y());
            is_whole = is_whole && there;
            if (there) least = std::min(least, there->top);
        }
        if (is_whole) {
            out.polygon = corners_of(cell_);
            out.z = {least - slack, std::min(out.z.top, 2 * middle->top - least + slack)};
        }
        all.push_back(std::move(out));
    }

    /// The sides that can be seen from above.
    void add_box(const Shape& box, Label label)
    {
        for (int axis = 0; axis < 3; ++axis) {
            const int next = (axis + 1) % 3, last = (axis + 2) % 3;
            const Mat3& turn = box.pose.rotation;
            const double sign = turn(2, axis) < 0 ? -1 : 1;
            const Vec3 normal = sign * turn.col(axis);
            if (!(normal.z() > 1e-9)) continue;
            const Vec3 middle = box.pose.position + box.size[axis] / 2 * normal;
            const Vec3 u = box.size[next] / 2 * turn.col(next), v = box.size[last] / 2 * turn.col(last);
            Facet out;
            out.terrain = label == Label::Terrain;
            out.water = label == Label::Water;
            Interval limits{inf, -inf};
            for (const auto& [i, j] : {std::pair{-1, -1}, {1, -1}, {1, 1}, {-1, 1}}) {
                const Vec3 corner = middle + i * u + j * v;
                out.polygon.push_back(corner.head<2>());
                limits = {std::min(limits.bottom, corner.z()), std::max(limits.top, corner.z())};
            }
            if (area_of(out.polygon) < 0) out.polygon.turn_round();
            if (are_parted(corners_, out.polygon, -4 * touch_tolerance)) continue;
            set_plane(middle, normal, limits, out);
            all.push_back(std::move(out));
        }
    }

    const Rect cell_;
    const SmallPolygon corners_;
    bool has_filled_terrain_ = false;
};

/// One cell under proof.
class CellProofs::Cell {
public:
    Cell(const CellProofs& proofs, const Rect& rect) : proofs_(proofs), rect_(rect), facets_(proofs.map_.geometry, rect) {}

    bool is_closed()
    {
        if (facets_.terrain.bottom > facets_.terrain.top) return true;
        find_bands();
        for (std::size_t b = 0; b < bands_.size(); ++b)
            if (!is_left_out(b) && !is_covered(bands_[b]) && !is_submerged(b) && !is_blocked(bands_[b]) && !is_in_ground(bands_[b]) &&
                !is_in_solid(bands_[b]))
                return false;
        return true;
    }

private:
    /// Heights between which layers may lie, from the bottom up, and not elsewhere.
    void find_bands()
    {
        if (facets_.has_too_many) {
            bands_.push_back(facets_.terrain);
            return;
        }
        drop_lower_ends();
        for (const Facet& facet : facets_.all)
            if (facet.terrain) bands_.push_back(facet.z);
        std::sort(bands_.begin(), bands_.end(), [](const Interval& l, const Interval& r) { return l.bottom < r.bottom; });
        std::size_t kept = 0;
        for (const Interval& next : bands_) {
            if (kept > 0 && next.bottom <= bands_[kept - 1].top + 2 * layer_tolerance) bands_[kept - 1].top = std::max(bands_[kept - 1].top, next.top);
            else bands_[kept++] = next;
        }
        bands_.resize(kept);
    }

    /// Crossings of a filled mesh at which a line that goes down leaves it are no layers. Faces that overlap in height are
    /// one cluster; between clusters all of the cell is inside, or outside, as its centre is.
    void drop_lower_ends()
    {
        std::vector<Facet*> filled;
        for (Facet& facet : facets_.all)
            if (facet.filled && !facet.water) filled.push_back(&facet);
        std::sort(filled.begin(), filled.end(), [](const Facet* l, const Facet* r) { return l->piece != r->piece ? l->piece < r->piece : l->z.top > r->z.top; });
        for (std::size_t i = 0; i < filled.size();) {
            const std::uint32_t piece = filled[i]->piece;
            std::size_t above = 0;  // crossings of the centre line
            while (i < filled.size() && filled[i]->piece == piece) {
                std::vector<Facet*> cluster;
                for (double bottom = filled[i]->z.bottom; i < filled.size() && filled[i]->piece == piece && filled[i]->z.top >= bottom; ++i) {
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

    /// Whether lines cross it once at most.
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

    /// Only the top layer is chosen, and there is one above.
    bool is_left_out(std::size_t b) const
    {
        const LayerChoice& layers = proofs_.options_.layers;
        const bool only_top = layers.kind == LayerChoice::Kind::Top || (layers.kind == LayerChoice::Kind::Index && layers.index == 0);
        if (!only_top || facets_.has_too_many || b + 1 == bands_.size()) return false;
        return covers(facets_.all, rect_, [&](const Facet& facet) { return facet.terrain && !facet.filled && facet.z.bottom > bands_[b].top + 2 * layer_tolerance; });
    }

    bool is_covered(const Interval& band) const
    {
        const double distance = proofs_.taken_.distance();
        if (!(distance > 0)) return false;
        const double offset = proofs_.options_.offset, low = band.bottom + offset, high = band.top + offset;
        const Vec3 middle(rect_.centre_x(), rect_.centre_y(), (low + high) / 2);
        const Vec3 half((rect_.high_x - rect_.low_x) / 2, (rect_.high_y - rect_.low_y) / 2, (high - low) / 2);
        if (half.norm() >= distance) return false;
        return proofs_.taken_.any_near(middle, [&](const Vec3& other) { return ((other - middle).cwiseAbs() + half).norm() < distance - slack; });
    }

    bool is_submerged(std::size_t b) const
    {
        const SampleOptions& options = proofs_.options_;
        const Interval& band = bands_[b];
        const bool any_depth = std::isinf(options.max_water_depth);
        // Whatever terrain is the ground of a pose must lie under the water: the layer, or one between that and the origin.
        double highest = band.top;
        for (std::size_t above = b + 1; above < bands_.size() && bands_[above].bottom <= band.top + options.offset + slack; ++above)
            highest = bands_[above].top;
        if (facets_.has_too_many || (!any_depth && options.offset < 0)) return false;
        return covers(facets_.all, rect_, [&](const Facet& facet) {
            if (!facet.water || facet.z.bottom < highest) return false;
            return any_depth || (!facet.filled && facet.z.top <= band.bottom + options.max_water_depth);
        });
    }

    bool is_blocked(const Interval& band) const
    {
        const Pose pose{{rect_.centre_x(), rect_.centre_y(), (band.bottom + band.top) / 2 + proofs_.options_.offset}, Mat3::Identity()};
        for (const DrawnIn& drawn_in : proofs_.drawn_in_)  // from the largest robot on
            if ((band.top - band.bottom) / 2 <= drawn_in.half_height) return !drawn_in.checker.is_free(pose);
        return false;
    }

    /// Whether a point of the robot's inside is within one solid at every pose of the band.
    bool is_in_solid(const Interval& band) const
    {
        return std::any_of(proofs_.prisms_.begin(), proofs_.prisms_.end(), [&](const Prism& prism) {
            const Vec2 shift = (prism.polygon[0] + prism.polygon[prism.polygon.size() / 2]) / 2;
            const double rise = proofs_.options_.offset + (prism.bottom + prism.top) / 2;
            return is_solid({rect_.low_x + shift.x(), rect_.low_y + shift.y(), rect_.high_x + shift.x(), rect_.high_y + shift.y()},
                            {band.bottom + rise - slack, band.top + rise + slack});
        });
    }

    /// Convex shapes hold a block if they hold its corners; so does the inside of a mesh that has the centre in it, and no
    /// surface where the block is.
    bool is_solid(const Rect& rect, const Interval& z) const
    {
        const auto holds = [&](const Interval& span) { return span.bottom <= z.bottom && span.top >= z.top; };
        bool in_primitive = false, meets_other = false;
        proofs_.map_.geometry.impl().visit_in(rect.low_x, rect.low_y, rect.high_x, rect.high_y, [&](const Tile& tile, std::uint32_t element) {
            const ElementBox& box = tile.boxes[element];
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
        const Column column = column_at(proofs_.map_.geometry, rect.centre_x(), rect.centre_y());
        return std::any_of(column.spans.begin(), column.spans.end(), [&](const Span& span) { return span.sealed && holds({span.bottom, span.top}); });
    }

    /// Whether some point of the robot's inside meets a terrain surface above or below it, at every pose of the band.
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
        const Rect there{rect_.low_x + shift.x(), rect_.low_y + shift.y(), rect_.high_x + shift.x(), rect_.high_y + shift.y()};
        const Facets ground(proofs_.map_.geometry, there);
        if (ground.has_too_many) return false;
        const double low = proofs_.options_.offset + prism.bottom + slack, high = proofs_.options_.offset + prism.top - slack;
        return covers(ground.all, there, [&](const Facet& facet) {
            return facet.terrain && facet.has_plane && std::all_of(stands.begin(), stands.end(), [&](const Facet* stand) {
                const Interval rise = rise_between(*stand, facet, shift);
                return rise.bottom >= low && rise.top <= high;
            });
        });
    }

    /// How much higher `to` is at the shift from where one stands on `from`, in the cell; nothing if they never meet.
    Interval rise_between(const Facet& from, const Facet& to, const Vec2& shift) const
    {
        Vec2 low(rect_.low_x, rect_.low_y), high(rect_.high_x, rect_.high_y);
        const auto narrow = [&](const SmallPolygon& polygon, const Vec2& by) {
            Vec2 least(inf, inf), most(-inf, -inf);
            for (const Vec2& p : polygon) {
                least = least.cwiseMin(p - by);
                most = most.cwiseMax(p - by);
            }
            low = low.cwiseMax(least - Vec2::Constant(slack));
            high = high.cwiseMin(most + Vec2::Constant(slack));
        };
        narrow(from.polygon, Vec2::Zero());
        narrow(to.polygon, shift);
        if (low.x() > high.x() || low.y() > high.y()) return {inf, -inf};
        const Vec2 middle = (low + high) / 2, half = (high - low) / 2;
        const double rise = to.at(middle.x() + shift.x(), middle.y() + shift.y()) - from.at(middle.x(), middle.y());
        const double reach = (to.slope - from.slope).cwiseAbs().dot(half);
        return {rise - reach, rise + reach};
    }

    const CellProofs& proofs_;
    const Rect rect_;
    Facets facets_;
    std::vector<Interval> bands_;
};

CellProofs::CellProofs(const Map& map, const CollisionChecker& checker, const SampleOptions& options, const SpacedPoints& taken)
    : map_(map), options_(options), taken_(taken)
{
    if (checker.uses_occupancy()) return;  // not what the proofs see
    const std::vector<Footprint> prints = options.random_yaw ? yaw_free_footprints(checker.robot())
                                                             : footprints(checker.robot(), rotation_from_rpy(0, 0, options.yaw), true);
    for (const Footprint& print : prints)
        if (!print.inner.polygon.empty()) prisms_.push_back({print.inner.polygon, print.inner.bottom, print.inner.top});
}

CellProofs::~CellProofs() = default;

void CellProofs::set_half_cell(double half_x, double half_y)
{
    drawn_in_.clear();
    for (const double share : {0.01, 0.1, 0.4, 1.0}) {
        const double half_height = share * std::max(half_x, half_y) + slack;
        Robot robot = drawn_in(half_x, half_y, half_height);
        if (!robot.parts.empty()) drawn_in_.push_back({half_height, CollisionChecker(map_.geometry, robot)});
    }
}

/// All of it is within the robot wherever that is moved by up to these lengths.
Robot CellProofs::drawn_in(double half_x, double half_y, double half_height) const
{
    Robot robot;
    robot.name = "drawn in";
    for (const Prism& prism : prisms_) {
        Polygon2 left = prism.polygon;
        for (std::size_t k = 0; k < prism.polygon.size() && !left.empty(); ++k) {
            const Vec2 &p = prism.polygon[k], &q = prism.polygon[(k + 1) % prism.polygon.size()];
            const Vec2 normal = outward(p, q);
            left = cut(left, normal, normal.dot(p) - half_x * std::abs(normal.x()) - half_y * std::abs(normal.y()) - slack);
        }
        const double bottom = prism.bottom + half_height, top = prism.top - half_height;
        constexpr double least = 1e-3;  // m; flatter or thinner bodies are not worth it
        left = convex_hull(std::move(left));
        if (left.size() < 3 || area_of(left) < least * least || !(top - bottom > least)) continue;
        std::vector<Vec3> corners;
        for (const Vec2& p : left) {
            corners.emplace_back(p.x(), p.y(), bottom);
            corners.emplace_back(p.x(), p.y(), top);
        }
        try {
            robot.parts.push_back(convex_hull(corners));
        } catch (const std::domain_error&) {
            continue;  // too thin after all: it proves nothing
        }
    }
    return robot;
}

bool CellProofs::is_closed(const Rect& cell) const { return Cell(*this, cell).is_closed(); }

}  // namespace spawnfield
