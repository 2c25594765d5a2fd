#include "base/parallel.h"
#include "base/rounding.h"
#include "geometry/tile.h"
#include "scene/elements.h"

#include <cstring>

namespace spawnfield {
namespace {

constexpr double pad = 1e-8;   // m; wider than touch_tolerance, so a line on an edge finds its triangle
constexpr int refinement = 4;  // factor between the cell sizes of two consecutive levels
constexpr double elements_per_tile = 256;
constexpr double most_tiles_along = 1024;  // along one side; limits the tiles of long, narrow scenes
constexpr double refs_per_element = 6;     // most bins that an element of a tile is in, on average

ElementBox box_of(const Scene& scene, std::uint32_t element)
{
    const Bounds bounds = element_bounds(scene, element);
    ElementBox box{};
    for (int axis = 0; axis < 3; ++axis) {
        box.min[std::size_t(axis)] = rounded_down(bounds.min[axis] - pad);
        box.max[std::size_t(axis)] = rounded_up(bounds.max[axis] + pad);
    }
    return box;
}

/// Returns the `count` values that begin at `next`, and moves `next` behind them.
template <class T>
std::span<const T> take(const char*& next, std::size_t count)
{
    const std::span<const T> out(reinterpret_cast<const T*>(next), count);
    next += count * sizeof(T);
    return out;
}

/// The elements in every tile of a level: those of tile t are elements[starts[t]] .. elements[starts[t + 1] - 1].
struct Members {
    std::vector<std::uint32_t> starts, elements;
};

Members sort_into_tiles(const Geometry::Impl& geometry, const TileLevel& level,
                        const std::vector<std::uint32_t>& elements, const std::vector<ElementBox>& boxes)
{
    Members out;
    out.starts.assign(std::size_t{level.cols} * level.rows + 1, 0);
    const auto visit_tiles = [&](const ElementBox& box, const auto& visit) {
        const auto col = [&](double x) { return cell_number(x - geometry.x0, level.cell, level.cols); };
        const auto row = [&](double y) { return cell_number(y - geometry.y0, level.cell, level.rows); };
        for (std::uint32_t r = row(box.min[1]); r <= row(box.max[1]); ++r)
            for (std::uint32_t c = col(box.min[0]); c <= col(box.max[0]); ++c) visit(std::size_t{r} * level.cols + c);
    };
    for (const std::uint32_t element : elements)
        visit_tiles(boxes[element], [&](std::size_t tile) { ++out.starts[tile + 1]; });
    for (std::size_t tile = 1; tile < out.starts.size(); ++tile) out.starts[tile] += out.starts[tile - 1];
    out.elements.resize(out.starts.back());
    std::vector<std::uint32_t> next(out.starts.begin(), out.starts.end() - 1);
    for (const std::uint32_t element : elements)
        visit_tiles(boxes[element], [&](std::size_t tile) { out.elements[next[tile]++] = element; });
    return out;
}

/// Builds the bytes of one tile.
class TileBuilder {
public:
    TileBuilder(const Scene& scene, const std::vector<ElementBox>& boxes, std::span<const std::uint32_t> elements,
                const Geometry::Impl& geometry, const TileLevel& level, std::size_t tile)
        : scene_(scene), boxes_(boxes), elements_(elements), geometry_(geometry), level_(level),
          col_(std::uint32_t(tile % level.cols)), row_(std::uint32_t(tile / level.cols))
    {
    }

    std::string build()
    {
        number_corners();
        const double side = level_.cell;
        TileHead head{.x0 = geometry_.x0 + col_ * side,
                      .y0 = geometry_.y0 + row_ * side,
                      .bin = side,
                      .vertices = std::uint32_t(vertices_.size()),
                      .triangles = triangles_,
                      .primitives = std::uint32_t(elements_.size()) - triangles_,
                      .pieces = std::uint32_t(pieces_.size()),
                      .refs = 0,
                      .bin_cols = 1,
                      .bin_rows = 1,
                      .unused = 0};
        sort_into_bins(head, side);
        out_.reserve(tile_size(head));
        put(head);
        for (const std::uint32_t vertex : vertices_) put(scene_.vertices[vertex]);
        for (std::size_t e = triangles_; e < elements_.size(); ++e) put(packed_primitive(elements_[e]));
        for (const std::uint32_t piece : pieces_) put(packed(piece));
        for (std::size_t e = 0; e < triangles_; ++e) put(packed_triangle(elements_[e]));
        for (const std::uint32_t element : elements_) put(boxes_[element]);
        for (const std::uint32_t element : elements_) put(element);
        for (const std::uint32_t start : starts_) put(start);
        for (const std::uint32_t ref : refs_) put(ref);
        return std::move(out_);
    }

private:
    /// Collects the vertices and the pieces of the tile's triangles. Their order gives them their numbers in the tile.
    void number_corners()
    {
        triangles_ = std::uint32_t(std::partition_point(elements_.begin(), elements_.end(),
                                                        [&](std::uint32_t e) { return is_triangle(scene_, e); }) -
                                   elements_.begin());
        for (std::size_t e = 0; e < triangles_; ++e) {
            for (const std::uint32_t corner : scene_.triangles[elements_[e]]) vertices_.push_back(corner);
            pieces_.push_back(scene_.triangle_pieces[elements_[e]]);
        }
        for (auto* list : {&vertices_, &pieces_}) {
            std::sort(list->begin(), list->end());
            list->erase(std::unique(list->begin(), list->end()), list->end());
        }
    }

    static std::uint32_t number_in(const std::vector<std::uint32_t>& sorted, std::uint32_t value)
    {
        return std::uint32_t(std::lower_bound(sorted.begin(), sorted.end(), value) - sorted.begin());
    }

    /// Divides the tile into about twice as many bins as it has elements, or into fewer, larger bins if the elements
    /// would be in more than refs_per_element bins on average. Sorts the elements into the bins.
    void sort_into_bins(TileHead& head, double side)
    {
        std::uint32_t along = std::uint32_t(std::ceil(std::sqrt(2.0 * double(elements_.size()))));
        for (;; along = (along + 1) / 2) {
            head.bin_cols = head.bin_rows = along;
            head.bin = side / along;
            double refs = 0;
            for (const std::uint32_t element : elements_) {
                const auto [col0, col1, row0, row1] = bins_of(head, boxes_[element]);
                refs += double(col1 - col0 + 1) * (row1 - row0 + 1);
            }
            if (along == 1 || refs <= refs_per_element * double(elements_.size())) break;
        }
        starts_.assign(std::size_t{along} * along + 1, 0);
        visit_bins(head, [&](std::size_t bin, std::uint32_t) { ++starts_[bin + 1]; });
        for (std::size_t bin = 1; bin < starts_.size(); ++bin) starts_[bin] += starts_[bin - 1];
        refs_.resize(starts_.back());
        head.refs = std::uint32_t(refs_.size());
        std::vector<std::uint32_t> next(starts_.begin(), starts_.end() - 1);
        visit_bins(head, [&](std::size_t bin, std::uint32_t element) { refs_[next[bin]++] = element; });
    }

    static std::array<std::uint32_t, 4> bins_of(const TileHead& head, const ElementBox& box)
    {
        return {cell_number(box.min[0] - head.x0, head.bin, head.bin_cols),
                cell_number(box.max[0] - head.x0, head.bin, head.bin_cols),
                cell_number(box.min[1] - head.y0, head.bin, head.bin_rows),
                cell_number(box.max[1] - head.y0, head.bin, head.bin_rows)};
    }

    template <class Visit>
    void visit_bins(const TileHead& head, const Visit& visit) const
    {
        for (std::uint32_t e = 0; e < elements_.size(); ++e) {
            const auto [col0, col1, row0, row1] = bins_of(head, boxes_[elements_[e]]);
            for (std::uint32_t row = row0; row <= row1; ++row)
                for (std::uint32_t col = col0; col <= col1; ++col) visit(std::size_t{row} * head.bin_cols + col, e);
        }
    }

    TileTriangle packed_triangle(std::uint32_t element) const
    {
        TileTriangle out{};
        for (std::size_t corner = 0; corner < 3; ++corner)
            out.corners[corner] = number_in(vertices_, scene_.triangles[element][corner]);
        out.piece = number_in(pieces_, scene_.triangle_pieces[element]);
        out.label = scene_.triangle_labels[element];
        out.home = home_of(element);
        return out;
    }

    Home home_of(std::uint32_t element) const
    {
        const ElementBox& box = boxes_[element];
        return {cell_number(box.min[0] - geometry_.x0, level_.cell, level_.cols) == col_,
                cell_number(box.min[1] - geometry_.y0, level_.cell, level_.rows) == row_};
    }

    TilePiece packed(std::uint32_t piece) const
    {
        const Piece& from = scene_.pieces[piece];
        TilePiece out{};
        out.bottom = from.bottom;
        out.piece = piece;
        out.part = from.part;
        out.solid = from.solid;
        out.open = from.open;
        out.sides_up = from.sides_up;
        return out;
    }

    TilePrimitive packed_primitive(std::uint32_t element) const
    {
        const Primitive& from = primitive_of(scene_, element);
        TilePrimitive out{};
        Vec3::Map(out.size.data()) = from.shape.size;
        Vec3::Map(out.position.data()) = from.shape.pose.position;
        Mat3::Map(out.rotation.data()) = from.shape.pose.rotation;
        out.part = from.part;
        out.kind = from.shape.kind;
        out.label = from.label;
        out.home = home_of(element);
        return out;
    }

    template <class T>
    void put(const T& value)
    {
        out_.append(reinterpret_cast<const char*>(&value), sizeof value);
    }

    const Scene& scene_;
    const std::vector<ElementBox>& boxes_;
    const std::span<const std::uint32_t> elements_;
    const Geometry::Impl& geometry_;
    const TileLevel& level_;
    const std::uint32_t col_, row_;  ///< of the tile
    std::uint32_t triangles_ = 0;
    std::vector<std::uint32_t> vertices_, pieces_, starts_, refs_;
    std::string out_;
};

}  // namespace

std::uint64_t tile_size(const TileHead& head)
{
    const std::uint64_t elements = std::uint64_t{head.triangles} + head.primitives;
    return sizeof(TileHead) + head.vertices * sizeof(Vec3) + head.primitives * sizeof(TilePrimitive) +
           head.pieces * sizeof(TilePiece) + head.triangles * sizeof(TileTriangle) +
           elements * (sizeof(ElementBox) + 4) + (std::uint64_t{head.bin_cols} * head.bin_rows + 1) * 4 +
           head.refs * 4ull;
}

Tile::Tile(std::string_view bytes) : head(reinterpret_cast<const TileHead*>(bytes.data()))
{
    const char* next = bytes.data() + sizeof(TileHead);
    vertices = take<Vec3>(next, head->vertices);
    primitives = take<TilePrimitive>(next, head->primitives);
    pieces = take<TilePiece>(next, head->pieces);
    triangles = take<TileTriangle>(next, head->triangles);
    boxes = take<ElementBox>(next, elements());
    ids = take<std::uint32_t>(next, elements());
    starts = take<std::uint32_t>(next, std::size_t{head->bin_cols} * head->bin_rows + 1);
    refs = take<std::uint32_t>(next, head->refs);
}

void Geometry::Impl::set_tiles(TileStore tiles)
{
    tiles_ = std::move(tiles);
    runs_.clear();
    for (const TileLevel& level : levels())
        runs_.push_back(std::make_unique<std::atomic<const HeightRun*>[]>(level.tiles.size()));
}

Geometry::Impl::~Impl()
{
    for (std::size_t l = 0; l < runs_.size(); ++l)
        for (std::size_t t = 0; t < levels()[l].tiles.size(); ++t) delete[] runs_[l][t].load(std::memory_order_relaxed);
}

const HeightRun* Geometry::Impl::make_height_runs(std::size_t level, std::size_t number, const Tile& tile) const
{
    auto made = std::make_unique<HeightRun[]>((tile.elements() + HeightRun::length - 1) / HeightRun::length);
    for (std::uint32_t element = 0; element < tile.elements(); ++element) {
        const ElementBox& box = tile.boxes[element];
        HeightRun& run = made[element / HeightRun::length];
        run.low = std::min(run.low, box.min[2]);
        run.high = std::max(run.high, box.max[2]);
    }
    const HeightRun* existing = nullptr;  // remains nullptr unless another thread was quicker
    if (runs_[level][number].compare_exchange_strong(existing, made.get(), std::memory_order_acq_rel,
                                                     std::memory_order_acquire))
        return made.release();
    return existing;
}

bool Geometry::Impl::is_consistent(std::string_view bytes) const
{
    if (bytes.size() < sizeof(TileHead)) return false;
    TileHead head;
    std::memcpy(&head, bytes.data(), sizeof head);
    const std::uint64_t size = tile_size(head);
    if (bytes.size() < size || bytes.size() >= size + tile_alignment) return false;
    if (!(head.bin > 0) || head.bin_cols == 0 || head.bin_rows == 0) return false;
    const Tile tile(bytes);
    const auto below = [](std::uint32_t value, std::size_t limit) { return value < limit; };
    for (const TileTriangle& t : tile.triangles) {
        for (const std::uint32_t corner : t.corners)
            if (!below(corner, tile.vertices.size())) return false;
        if (!below(t.piece, tile.pieces.size()) || t.label > Label::Water) return false;
    }
    for (const TilePiece& p : tile.pieces)
        if (!below(p.part, parts.size())) return false;
    for (const TilePrimitive& p : tile.primitives)
        if (p.kind > ShapeKind::Capsule || p.label > Label::Water || !below(p.part, parts.size())) return false;
    if (tile.starts.front() != 0 || tile.starts.back() != tile.refs.size()) return false;
    return std::is_sorted(tile.starts.begin(), tile.starts.end()) &&
           std::all_of(tile.refs.begin(), tile.refs.end(),
                       [&](std::uint32_t ref) { return below(ref, tile.elements()); });
}

Geometry::Impl::Visits& Geometry::Impl::visits_of_thread()
{
    thread_local Visits visits;
    return visits;
}

double Geometry::Impl::elements_near(double low_x, double low_y, double high_x, double high_y) const
{
    constexpr double bytes_per_element = 100;
    double sum = 0;
    for (const TileLevel& level : levels()) {
        // Returns the share of the side of tile number n that lies in low .. high.
        const auto share = [&](double low, double high, double origin, std::uint32_t n) {
            const double start = origin + n * level.cell;
            return std::clamp((std::min(high, start + level.cell) - std::max(low, start)) / level.cell, 0.0, 1.0);
        };
        const std::uint32_t col0 = cell_number(low_x - x0, level.cell, level.cols),
                            col1 = cell_number(high_x - x0, level.cell, level.cols);
        const std::uint32_t row0 = cell_number(low_y - y0, level.cell, level.rows),
                            row1 = cell_number(high_y - y0, level.cell, level.rows);
        for (std::uint32_t row = row0; row <= row1; ++row)
            for (std::uint32_t col = col0; col <= col1; ++col)
                sum += double(level.tiles[std::size_t{row} * level.cols + col].size) * share(low_x, high_x, x0, col) *
                       share(low_y, high_y, y0, row);
    }
    return sum / bytes_per_element;
}

Geometry::Geometry() : impl_(std::make_shared<const Impl>()) {}

Geometry::Geometry(std::shared_ptr<const Impl> impl) : impl_(std::move(impl)) {}

std::uint64_t Geometry::element_count() const { return impl_->elements; }
const Bounds& Geometry::bounds() const { return impl_->bounds; }
const std::vector<Part>& Geometry::parts() const { return impl_->parts; }
const LabelCounts& Geometry::labels() const { return impl_->labels; }

Geometry::Geometry(const Scene& scene, int threads)
{
    auto impl = std::make_shared<Impl>();
    const auto elements = std::uint32_t(spawnfield::element_count(scene));
    impl->elements = elements;
    impl->parts = scene.parts;
    impl->labels = scene.count_labels();
    impl->has_filled_meshes = std::any_of(scene.pieces.begin(), scene.pieces.end(),
                                          [](const Piece& p) { return p.solid; });
    if (elements > 0) {
        std::vector<ElementBox> boxes(elements);
        parallel_for(elements, threads, {}, [&](std::size_t e) { boxes[e] = box_of(scene, std::uint32_t(e)); });
        const Bounds bounds = scene.bounds();
        impl->bounds = bounds;
        impl->x0 = bounds.min.x() - pad;
        impl->y0 = bounds.min.y() - pad;
        const double width = bounds.max.x() - bounds.min.x() + 2 * pad,
                     depth = bounds.max.y() - bounds.min.y() + 2 * pad;
        double cell = std::max(std::sqrt(width * depth * elements_per_tile / elements),
                               std::max(width, depth) / most_tiles_along);

        // The elements of each level. An element belongs to the first level whose tiles are not smaller than itself.
        std::vector<std::vector<std::uint32_t>> members(1);
        for (std::uint32_t element = 0; element < elements; ++element) {
            const ElementBox& box = boxes[element];
            const double size = std::max(double(box.max[0]) - box.min[0], double(box.max[1]) - box.min[1]);
            std::size_t level = 0;
            for (double side = cell; side < size; side *= refinement) ++level;
            if (level >= members.size()) members.resize(level + 1);
            members[level].push_back(element);
        }
        TileStoreBuilder store(0);
        for (const std::vector<std::uint32_t>& list : members) {
            if (!list.empty()) {
                TileLevel level(cell, std::uint32_t(std::ceil(width / cell)), std::uint32_t(std::ceil(depth / cell)),
                                1);
                const Members sorted = sort_into_tiles(*impl, level, list, boxes);
                std::vector<std::string> tiles(sorted.starts.size() - 1);
                parallel_for(tiles.size(), threads, {}, [&](std::size_t t) {
                    const std::span<const std::uint32_t> in_tile(sorted.elements.data() + sorted.starts[t],
                                                                 sorted.starts[t + 1] - sorted.starts[t]);
                    if (!in_tile.empty()) tiles[t] = TileBuilder(scene, boxes, in_tile, *impl, level, t).build();
                });
                store.add(std::move(level), std::move(tiles), threads);
            }
            cell *= refinement;
        }
        impl->set_tiles(store.build());
    }
    impl_ = std::move(impl);
}

}  // namespace spawnfield
