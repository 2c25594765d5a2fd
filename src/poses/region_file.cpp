#include "base/csv.h"
#include "base/input_file.h"
#include "base/number.h"
#include "base/polygon2.h"
#include "base/text.h"
#include "poses/pose_columns.h"
#include "scene/nav2_map.h"

#include <spawnfield/error.h>
#include <spawnfield/region_file.h>

#include <nlohmann/json.hpp>

#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>

namespace spawnfield {
namespace {

using GeoJson = nlohmann::json;
using Ring = Region::Ring;

/// Returns the ring without its repeated first corner and without corners that repeat the one before.
Ring without_repeats(Ring ring)
{
    ring.erase(std::unique(ring.begin(), ring.end()), ring.end());
    while (ring.size() > 1 && ring.front() == ring.back()) ring.pop_back();
    return ring;
}

/// Returns the ring without repeated corners. Throws FileError if it has fewer than 3 corners or no area. `place` is
/// the ring's place in the file, for messages.
Ring checked(Ring ring, const std::string& file, const std::string& place)
{
    ring = without_repeats(std::move(ring));
    if (ring.size() < 3)
        throw FileError(file, place + " has " + std::to_string(ring.size()) + " different corners, needs at least 3");
    const auto is_nearer = [&](const Vec2& a, const Vec2& b) { return (a - ring[0]).norm() < (b - ring[0]).norm(); };
    const Vec2 along = *std::max_element(ring.begin(), ring.end(), is_nearer) - ring[0];
    const bool is_line = std::all_of(ring.begin(), ring.end(), [&](const Vec2& p) {
        return std::abs(cross(along, p - ring[0])) <= 1e-9 * along.norm();
    });
    if (is_line) throw FileError(file, place + " has no area: its corners lie on one line");
    return ring;
}

// ---- GeoJSON ----

class GeoJsonReader {
public:
    GeoJsonReader(std::string file, Region& out) : file_(std::move(file)), out_(out) {}

    void read(const GeoJson& node, const std::string& place)
    {
        constexpr std::size_t longest = 1000;  // characters; no real file nests its collections deeper
        if (place.size() > longest) fail(place.substr(0, 40) + "…", "is nested too deep");
        if (!node.is_object()) fail(place, "is not an object");
        refuse_degrees(node);
        const std::string type = text(node, "type");
        if (type == "Polygon")
            polygon(member(node, "coordinates", place), place + ".coordinates");
        else if (type == "MultiPolygon")
            each(node, "coordinates", place,
                 [&](const GeoJson& one, const std::string& inside) { polygon(one, inside); });
        else if (type == "GeometryCollection")
            each(node, "geometries", place, [&](const GeoJson& one, const std::string& inside) { read(one, inside); });
        else if (type == "FeatureCollection")
            each(node, "features", place, [&](const GeoJson& one, const std::string& inside) { read(one, inside); });
        else if (type == "Feature")
            feature(node, place);
        else if (type == "Point" || type == "MultiPoint" || type == "LineString" || type == "MultiLineString")
            ++without_area_;
        else
            fail(place, "has type \"" + type +
                            "\", needs Polygon, MultiPolygon, Feature, FeatureCollection or GeometryCollection");
    }

    void finish()
    {
        if (out_.polygons.empty())
            throw FileError(file_, "has no polygon" + (without_area_ > 0 ? ", only " + ignored() : std::string()));
        if (without_area_ > 0)
            out_.notices.push_back(file_ + ": " + ignored() + " ignored: points and lines have no area");
    }

private:
    [[noreturn]] void fail(const std::string& place, const std::string& what) const
    {
        throw FileError(file_, place + " " + what);
    }
    std::string ignored() const
    {
        return std::to_string(without_area_) + (without_area_ == 1 ? " point or line" : " points or lines");
    }

    static std::string text(const GeoJson& node, const char* key)
    {
        return node.contains(key) && node[key].is_string() ? node[key].get<std::string>() : "";
    }

    const GeoJson& member(const GeoJson& node, const char* key, const std::string& place) const
    {
        if (!node.contains(key) || !node[key].is_array()) fail(place + "." + key, "is missing or is not a list");
        return node[key];
    }

    template <class Visit>
    void each(const GeoJson& node, const char* key, const std::string& place, const Visit& visit)
    {
        std::size_t number = 0;
        for (const GeoJson& one : member(node, key, place))
            visit(one, place + "." + key + "[" + std::to_string(number++) + "]");
    }

    void feature(const GeoJson& node, const std::string& place)
    {
        if (!node.contains("geometry")) fail(place + ".geometry", "is missing");
        if (!node["geometry"].is_null()) read(node["geometry"], place + ".geometry");
    }

    /// Throws FileError if a crs member names coordinates in degrees, and adds a notice for other names. Only GeoJSON
    /// before RFC 7946 has this member.
    void refuse_degrees(const GeoJson& node)
    {
        if (!node.contains("crs") || !node["crs"].is_object() || !node["crs"].contains("properties")) return;
        const std::string name = text(node["crs"]["properties"], "name");
        if (name.ends_with("CRS84") || name.ends_with(":4326") || name.ends_with("CRS83") || name.ends_with(":4269"))
            throw FileError(file_,
                            "has crs " + name +
                                ", which is in degrees; needs metres in the map's frame (ogr2ogr -t_srs converts it)");
        if (!name.empty())
            out_.notices.push_back(file_ + ": crs " + name +
                                   " is ignored: coordinates are taken as metres in the map's frame");
    }

    void polygon(const GeoJson& rings, const std::string& place)
    {
        if (!rings.is_array() || rings.empty()) fail(place, "is not a list of rings");
        Region::Polygon out;
        for (std::size_t i = 0; i < rings.size(); ++i)
            out.push_back(ring(rings[i], place + "[" + std::to_string(i) + "]"));
        out_.polygons.push_back(std::move(out));
    }

    Ring ring(const GeoJson& corners, const std::string& place) const
    {
        if (!corners.is_array()) fail(place, "is not a ring (a list of positions)");
        Ring out;
        for (std::size_t i = 0; i < corners.size(); ++i) {
            const GeoJson& p = corners[i];
            if (!p.is_array() || p.size() < 2 || !p[0].is_number() || !p[1].is_number())
                fail(place + "[" + std::to_string(i) + "]", "is not a position [x, y]");
            out.emplace_back(p[0].get<double>(), p[1].get<double>());
            if (!std::isfinite(out.back().x()) || !std::isfinite(out.back().y()))
                fail(place + "[" + std::to_string(i) + "]", "is not finite");
        }
        if (out.size() > 1 && out.front() != out.back())
            fail(place, "is not closed: its last position differs from its first");
        return checked(std::move(out), file_, place);
    }

    const std::string file_;
    Region& out_;
    std::size_t without_area_ = 0;
};

void read_geojson(const std::string& text, const std::string& file, Region& out)
{
    GeoJson root;
    try {
        root = GeoJson::parse(text);
    } catch (const GeoJson::exception& error) {
        throw FileError(file, std::string("is not valid JSON: ") + error.what());
    }
    GeoJsonReader reader(file, out);
    reader.read(root, "$");
    reader.finish();
}

// ---- CSV ----

class CsvPolygons {
public:
    CsvPolygons(const std::string& file, Region& out) : file_(file), out_(out) {}

    void line(std::string_view text)
    {
        ++line_;
        const std::string trim = trimmed(text);
        if (trim.empty()) return close();
        if (trim[0] == '#') return;
        if (const std::string complaint = first_ ? separator_complaint(trim) : ""; !complaint.empty()) fail(complaint);
        const std::vector<std::string> fields = csv_fields(trim);
        double ignored_number = 0;
        if (first_ && !parse_number(fields[0], ignored_number)) return header(fields);
        first_ = false;
        if (fields.size() <= std::max(columns_[0], columns_[1]) || (polygon_column_ == none && fields.size() != 2))
            fail("has " + std::to_string(fields.size()) + " fields, needs x,y (a header line names further ones)");
        const std::string polygon = polygon_column_ < fields.size() ? fields[polygon_column_] : "";
        if (!ring_.empty() && polygon != polygon_) close();
        polygon_ = polygon;
        if (ring_.empty()) ring_line_ = line_;
        Vec2 p;
        for (std::size_t axis = 0; axis < 2; ++axis) {
            const std::string& field = fields[columns_[axis]];
            if (!parse_number(field, p[Eigen::Index(axis)]) || !std::isfinite(p[Eigen::Index(axis)]))
                fail("\"" + field + "\" is not a finite number");
        }
        ring_.push_back(p);
    }

    void finish()
    {
        close();
        if (out_.polygons.empty()) throw FileError(file_, "has no polygon: x,y of three corners or more are needed");
    }

private:
    static constexpr std::size_t none = std::size_t(-1);

    [[noreturn]] void fail(const std::string& what) const
    {
        throw FileError(file_, "line " + std::to_string(line_) + ": " + what);
    }

    void header(const std::vector<std::string>& names)
    {
        first_ = false;
        const auto find = [&](const char* name) {
            return std::size_t(std::find(names.begin(), names.end(), name) - names.begin());
        };
        columns_ = {find("x"), find("y")};
        if (std::max(columns_[0], columns_[1]) >= names.size())
            fail("has neither numbers x,y nor the names of such columns");
        polygon_column_ = find("polygon");
        if (polygon_column_ >= names.size()) refuse_poses(names);
        if (polygon_column_ >= names.size()) polygon_column_ = none - 1;  // other columns are ignored
    }

    /// Throws FileError if there are columns of poses: robots' positions are hardly meant as corners of a polygon.
    void refuse_poses(const std::vector<std::string>& names) const
    {
        const auto is_of_pose = [](const std::string& name) {
            return name != "x" && name != "y" && (is_pose_column(name) || is_verdict_column(name, true, true));
        };
        const auto found = std::find_if(names.begin(), names.end(), is_of_pose);
        if (found != names.end())
            fail("has a column " + *found +
                 ": these are poses, not the corners of a polygon; `sample` and `search` keep a distance from poses "
                 "with --avoid FILE --avoid-distance M; a polygon has columns x,y, and polygon if there are several");
    }

    void close()
    {
        if (ring_.empty()) return;
        out_.polygons.push_back(
            {checked(std::move(ring_), file_, "line " + std::to_string(ring_line_) + ": the polygon")});
        ring_.clear();
    }

    const std::string& file_;
    Region& out_;
    Ring ring_;
    std::string polygon_;
    std::array<std::size_t, 2> columns_{0, 1};
    std::size_t polygon_column_ = none, line_ = 0, ring_line_ = 0;
    bool first_ = true;
};

void read_csv(const std::string& text, const std::string& file, Region& out)
{
    CsvPolygons reader(file, out);
    for (std::size_t start = text.starts_with(byte_order_mark) ? byte_order_mark.size() : 0; start < text.size();) {
        const std::size_t end = std::min(text.find('\n', start), text.size());
        reader.line(std::string_view(text).substr(start, end - start));
        start = end + 1;
    }
    reader.finish();
}

// ---- nav2 ----

/// The rings around the wanted cells. Each ring has these cells on its left.
class CellRings {
public:
    CellRings(const Nav2Map& map, Nav2Map::Cell wanted)
        : map_(map), wanted_(wanted), ways_(std::size_t(map.rows + 1) * std::size_t(map.cols + 1))
    {
        for (int row = 0; row < map.rows; ++row)
            for (int col = 0; col < map.cols; ++col) {
                if (!is_in(row, col)) continue;
                if (!is_in(row + 1, col)) ways_at(row + 1, col) |= 1 << east;
                if (!is_in(row, col + 1)) ways_at(row + 1, col + 1) |= 1 << north;
                if (!is_in(row - 1, col)) ways_at(row, col + 1) |= 1 << west;
                if (!is_in(row, col - 1)) ways_at(row, col) |= 1 << south;
            }
    }

    Region::Polygon rings()
    {
        Region::Polygon out;
        for (int row = 0; row <= map_.rows; ++row)
            for (int col = 0; col <= map_.cols; ++col)
                while (ways_at(row, col) != 0) out.push_back(ring_from(row, col));
        return out;
    }

private:
    enum Way { east, north, west, south };

    bool is_in(int row, int col) const
    {
        return row >= 0 && col >= 0 && row < map_.rows && col < map_.cols && map_.cell(row, col) == wanted_;
    }
    std::uint8_t& ways_at(int row, int col)
    {
        return ways_[std::size_t(row) * std::size_t(map_.cols + 1) + std::size_t(col)];
    }

    Ring ring_from(int row, int col)
    {
        const int first_row = row, first_col = col;
        Ring out;
        int way = east;
        while ((ways_at(row, col) & 1 << way) == 0) ++way;
        do {
            ways_at(row, col) = std::uint8_t(ways_at(row, col) & ~(1 << way));
            if (out.empty() || way != last_) out.push_back(map_.corner(row, col).head<2>());
            last_ = way;
            row += way == south ? 1 : way == north ? -1 : 0;
            col += way == east ? 1 : way == west ? -1 : 0;
            for (const int turn : {1, 0, 3})  // left first, then straight on
                if (const int next = (last_ + turn) % 4; (ways_at(row, col) & 1 << next) != 0) {
                    way = next;
                    break;
                }
        } while (row != first_row || col != first_col);
        return out;
    }

    const Nav2Map& map_;
    const Nav2Map::Cell wanted_;
    std::vector<std::uint8_t>
        ways_;  ///< for each crossing of the grid's lines: a bit for each edge of a ring that leaves it
    int last_ = east;
};

void read_cells(const std::filesystem::path& file, MapCells cells, Region& out)
{
    if (!is_nav2_map(file))
        throw FileError(file.string(), "is not a 2D map of nav2 or ROS (keys image, resolution, origin, …)");
    const Nav2Map map = read_nav2_map(file);
    out.notices = map.notices;
    Region::Polygon rings =
        CellRings(map, cells == MapCells::Free ? Nav2Map::Cell::Free : Nav2Map::Cell::Occupied).rings();
    if (rings.empty())
        throw FileError(file.string(), std::string("has no ") + (cells == MapCells::Free ? "free" : "occupied") +
                                           " cell; are negate and the thresholds right?");
    out.polygons.push_back(std::move(rings));
}

}  // namespace

Region parse_region(const std::string& text, const std::string& name)
{
    Region out;
    out.name = name;
    const std::size_t first = text.find_first_not_of(" \t\r\n");
    if (first != std::string::npos && text[first] == '{')
        read_geojson(text, name, out);
    else
        read_csv(text, name, out);
    return out;
}

Region read_region(const std::filesystem::path& file, MapCells cells)
{
    require_file(file);
    Region out;
    out.name = file.filename().string();
    const std::string extension = lower_case(file.extension().string());
    if (extension == ".yaml" || extension == ".yml")
        read_cells(file, cells, out);
    else if (extension == ".json" || extension == ".geojson")
        read_geojson(read_file(file), file.string(), out);
    else
        read_csv(read_file(file), file.string(), out);
    return out;
}

}  // namespace spawnfield
