#include "scene/extrusion.h"

#include "base/number.h"
#include "base/polygon2.h"

#include <algorithm>
#include <stdexcept>

namespace spawnfield {
namespace {

using Ring = std::vector<Vec2>;

double turn(const Vec2& a, const Vec2& b, const Vec2& c) { return cross(b - a, c - a); }

/// Returns point i of a closed ring: after the last point comes the first again.
const Vec2& point_of(const Ring& ring, std::size_t i) { return ring[i % ring.size()]; }

Ring cleaned(const Outline& outline, std::size_t outline_number)
{
    Ring ring;
    for (const auto& [x, y] : outline) {
        const Vec2 point(x, y);
        if (!point.allFinite())
            throw std::domain_error("outline " + std::to_string(outline_number) + " has a point that is not finite");
        if (ring.empty() || point != ring.back()) ring.push_back(point);
    }
    while (ring.size() > 1 && ring.front() == ring.back()) ring.pop_back();
    if (ring.size() < 3)
        throw std::domain_error("outline " + std::to_string(outline_number) + " has " + std::to_string(ring.size()) +
                                " points, needs 3 or more");
    if (area_of(ring) == 0) throw std::domain_error("outline " + std::to_string(outline_number) + " encloses no area");
    if (area_of(ring) < 0) std::reverse(ring.begin(), ring.end());
    return ring;
}

/// Returns whether two segments cross between their ends, or an end of one lies on the other between its ends.
bool cross_each_other(const Vec2& a, const Vec2& b, const Vec2& c, const Vec2& d)
{
    const double c_side = turn(a, b, c), d_side = turn(a, b, d), a_side = turn(c, d, a), b_side = turn(c, d, b);
    if (((c_side > 0 && d_side < 0) || (c_side < 0 && d_side > 0)) &&
        ((a_side > 0 && b_side < 0) || (a_side < 0 && b_side > 0)))
        return true;
    const auto within = [](const Vec2& from, const Vec2& to, const Vec2& point, double side) {
        return side == 0 && point != from && point != to && (point - from).dot(point - to) < 0;
    };
    return within(a, b, c, c_side) || within(a, b, d, d_side) || within(c, d, a, a_side) || within(c, d, b, b_side);
}

void require_simple(const std::vector<Ring>& rings)
{
    for (std::size_t r = 0; r < rings.size(); ++r)
        for (std::size_t s = r; s < rings.size(); ++s)
            for (std::size_t i = 0; i < rings[r].size(); ++i)
                for (std::size_t j = r == s ? i + 1 : 0; j < rings[s].size(); ++j) {
                    const Vec2 &a = rings[r][i], &b = point_of(rings[r], i + 1), &c = rings[s][j],
                               &d = point_of(rings[s], j + 1);
                    if (cross_each_other(a, b, c, d))
                        throw std::domain_error("its outline crosses itself near (" + number(a.x()) + ", " +
                                                number(a.y()) + ")");
                }
}

/// Returns whether a ring contains a point. It counts the crossings of the ring with a ray along x. Valid for a point
/// that is not on the ring.
bool encloses(const Ring& ring, const Vec2& point)
{
    bool inside = false;
    for (std::size_t i = 0; i < ring.size(); ++i) {
        const Vec2 &p = ring[i], &q = point_of(ring, i + 1);
        if ((p.y() > point.y()) == (q.y() > point.y())) continue;
        inside ^= point.x() < p.x() + (point.y() - p.y()) / (q.y() - p.y()) * (q.x() - p.x());
    }
    return inside;
}

/// Joins a hole to its outer ring: two edges in opposite directions (a bridge) make one polygon of both.
void join_hole(Ring& outer, const Ring& hole, const std::vector<Ring>& holes)
{
    struct Bridge {
        double length;
        std::size_t from, to;
    };
    std::vector<Bridge> bridges;
    for (std::size_t i = 0; i < outer.size(); ++i)
        for (std::size_t j = 0; j < hole.size(); ++j) bridges.push_back({(outer[i] - hole[j]).norm(), i, j});
    std::sort(bridges.begin(), bridges.end(), [](const Bridge& a, const Bridge& b) { return a.length < b.length; });
    const auto is_free = [&](const Bridge& bridge) {
        const auto crosses = [&](const Ring& ring) {
            for (std::size_t k = 0; k < ring.size(); ++k)
                if (cross_each_other(outer[bridge.from], hole[bridge.to], ring[k], point_of(ring, k + 1))) return true;
            return false;
        };
        return !crosses(outer) && std::none_of(holes.begin(), holes.end(), crosses);
    };
    const auto found = std::find_if(bridges.begin(), bridges.end(), is_free);
    if (found == bridges.end()) throw std::domain_error("a hole cannot be joined to its outline");
    Ring joined(outer.begin(), outer.begin() + std::ptrdiff_t(found->from) + 1);
    for (std::size_t k = 0; k <= hole.size(); ++k)
        joined.push_back(
            point_of(hole, found->to + hole.size() - k % hole.size()));  // in the opposite direction of the outline
    joined.insert(joined.end(), outer.begin() + std::ptrdiff_t(found->from), outer.end());
    outer = std::move(joined);
}

/// Returns the triangles of a counterclockwise polygon, as indices into it. Its edges may touch, as those of bridges
/// do. Source: Meisters, Polygons have triangulated, 1975; Eberly, Triangulation by ear clipping, 2002.
std::vector<std::array<std::size_t, 3>> triangulated(const Ring& polygon)
{
    std::vector<std::size_t> remaining(polygon.size());
    for (std::size_t i = 0; i < remaining.size(); ++i) remaining[i] = i;
    std::vector<std::array<std::size_t, 3>> out;
    const auto is_ear = [&](std::size_t k, bool flat) {
        const std::size_t n = remaining.size();
        const Vec2 &a = polygon[remaining[(k + n - 1) % n]], &b = polygon[remaining[k]],
                   &c = polygon[remaining[(k + 1) % n]];
        const double area = turn(a, b, c);
        if (flat ? area != 0 : !(area > 0)) return false;
        return std::none_of(remaining.begin(), remaining.end(), [&](std::size_t i) {
            const Vec2& p = polygon[i];
            return !flat && p != a && p != b && p != c && turn(a, b, p) >= 0 && turn(b, c, p) >= 0 &&
                   turn(c, a, p) >= 0;
        });
    };
    while (remaining.size() > 3) {
        std::size_t ear = remaining.size();
        for (const bool flat : {false, true})  // flat ears have no area: they are used only if there is no other
            for (std::size_t k = 0; k < remaining.size() && ear == remaining.size(); ++k)
                if (is_ear(k, flat)) ear = k;
        if (ear == remaining.size()) throw std::domain_error("its outline crosses or touches itself");
        const std::size_t n = remaining.size();
        out.push_back({remaining[(ear + n - 1) % n], remaining[ear], remaining[(ear + 1) % n]});
        remaining.erase(remaining.begin() + std::ptrdiff_t(ear));
    }
    out.push_back({remaining[0], remaining[1], remaining[2]});
    return out;
}

/// Makes a closed prism: walls, floor and lid with welded corners.
class PrismMaker {
public:
    explicit PrismMaker(double height) : height_(height) { node_.name = "polyline"; }

    void add_walls(const Ring& ring, bool is_hole)
    {
        for (std::size_t i = 0; i < ring.size(); ++i) {
            const Vec2 &from = is_hole ? point_of(ring, i + 1) : ring[i],
                       &to = is_hole ? ring[i] : point_of(ring, i + 1);
            add(corner(from, false), corner(to, false), corner(to, true));
            add(corner(from, false), corner(to, true), corner(from, true));
        }
    }

    void add_lids(const Ring& polygon)
    {
        for (const auto& [a, b, c] : triangulated(polygon)) {
            add(corner(polygon[a], true), corner(polygon[b], true), corner(polygon[c], true));
            add(corner(polygon[c], false), corner(polygon[b], false), corner(polygon[a], false));
        }
    }

    FileMesh::Node take() { return std::move(node_); }

private:
    std::uint32_t corner(const Vec2& point, bool is_top)
    {
        const auto [entry, is_new] = index_.try_emplace({point.x(), point.y(), is_top},
                                                        std::uint32_t(node_.vertices.size()));
        if (is_new) node_.vertices.emplace_back(point.x(), point.y(), is_top ? height_ : 0);
        return entry->second;
    }

    void add(std::uint32_t a, std::uint32_t b, std::uint32_t c)
    {
        node_.triangles.push_back({a, b, c});
        node_.materials.push_back(0);
    }

    const double height_;
    FileMesh::Node node_;
    std::map<std::tuple<double, double, bool>, std::uint32_t> index_;
};

}  // namespace

FileMesh extruded(const std::vector<Outline>& outlines, double height)
{
    std::vector<Ring> rings;
    for (const Outline& outline : outlines) rings.push_back(cleaned(outline, rings.size() + 1));
    require_simple(rings);
    // Depth decides: an outline within an even number of others encloses solid space, one within an odd number is a
    // hole.
    const auto parents_of = [&](std::size_t ring) {
        std::vector<std::size_t> out;
        for (std::size_t other = 0; other < rings.size(); ++other)
            if (other != ring && encloses(rings[other], (rings[ring][0] + rings[ring][1]) / 2)) out.push_back(other);
        return out;
    };
    std::vector<std::vector<std::size_t>> parents;
    for (std::size_t ring = 0; ring < rings.size(); ++ring) parents.push_back(parents_of(ring));
    FileMesh mesh;
    mesh.materials.push_back("");
    for (std::size_t outer = 0; outer < rings.size(); ++outer) {
        if (parents[outer].size() % 2 == 1) continue;
        std::vector<Ring> holes;
        for (std::size_t hole = 0; hole < rings.size(); ++hole)
            if (parents[hole].size() == parents[outer].size() + 1 &&
                std::count(parents[hole].begin(), parents[hole].end(), outer) == 1)
                holes.push_back(rings[hole]);
        PrismMaker maker(height);
        maker.add_walls(rings[outer], false);
        Ring polygon = rings[outer];
        for (const Ring& hole : holes) {
            maker.add_walls(hole, true);
            join_hole(polygon, hole, holes);
        }
        maker.add_lids(polygon);
        mesh.nodes.push_back(maker.take());
    }
    return mesh;
}

}  // namespace spawnfield
