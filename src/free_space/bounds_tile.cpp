#include "free_space/bounds_tile.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>

namespace spawnfield {
namespace {

constexpr double steps = 65500;         // quantized heights of a tile; fewer than 65535, so that rounding outwards fits
constexpr double least_quantum = 1e-6;  // m
constexpr std::size_t words = BoundsTile::cells / 64;
constexpr std::size_t first_head_size = 40;  // bytes; of version 1

/// The arrays of a uniform tile, which are the same for all of them.
struct UniformArrays {
    static constexpr std::uint16_t top = 65502;  ///< the value of all tops
    std::array<std::uint16_t, BoundsTile::cells> tops, lists{};
    std::array<std::uint64_t, words> marks;
    std::array<std::uint16_t, words> ranks;

    UniformArrays()
    {
        tops.fill(top);
        marks.fill(~std::uint64_t{0});
        for (std::size_t word = 0; word < words; ++word) ranks[word] = std::uint16_t(64 * word);
    }
};

const UniformArrays& uniform_arrays()
{
    static const UniformArrays arrays;
    return arrays;
}

std::size_t padded(std::size_t size) { return (size + 7) / 8 * 8; }

/// The sizes of the arrays of a tile's intervals.
struct ListSizes {
    std::size_t cells, lists, spans;
    bool has_numbers;  ///< each marked cell has the number of its list
    bool is_uniform;

    std::size_t bytes() const
    {
        if (cells == 0) return 0;
        const std::size_t intervals = padded(4 * (lists + 1 + spans));
        return is_uniform ? intervals : intervals + 10 * words + (has_numbers ? padded(2 * cells) : 0);
    }
};

ListSizes list_sizes(const BoundsHead& head, std::uint32_t cells, std::uint32_t lists, std::uint32_t spans)
{
    const bool is_uniform = head.is_uniform != 0;
    return {cells, is_uniform ? 1 : lists > 0 ? lists : cells, spans, lists > 0, is_uniform};
}
ListSizes bound_sizes(const BoundsHead& head)
{
    return list_sizes(head, head.bound_cells, head.bound_lists, head.bounds);
}
ListSizes solid_sizes(const BoundsHead& head)
{
    return list_sizes(head, head.solid_cells, head.solid_lists, head.solids);
}

std::size_t head_size(std::uint32_t version) { return version == 1 ? first_head_size : sizeof(BoundsHead); }

BoundsHead head_of(std::string_view bytes, std::uint32_t version)
{
    BoundsHead head{};
    std::memcpy(&head, bytes.data(), head_size(version));
    return head;
}

/// Returns the size of a tile with this head, bytes, without the padding at its end.
std::size_t tile_size(const BoundsHead& head, std::uint32_t version)
{
    return head_size(version) + bound_sizes(head).bytes() + solid_sizes(head).bytes() +
           (head.is_uniform != 0 ? 0 : BoundsTile::cells * sizeof(std::uint16_t));
}

/// Finds the arrays of intervals that begin at `at`. Returns where they end.
const char* read_list(const char* at, const ListSizes& sizes, CellIntervals& out)
{
    if (sizes.cells == 0) return at;
    const char* const end = at + sizes.bytes();
    if (sizes.is_uniform) {
        const UniformArrays& all = uniform_arrays();
        out.marks = all.marks.data();
        out.ranks = all.ranks.data();
        out.lists = all.lists.data();
    } else {
        out.marks = reinterpret_cast<const std::uint64_t*>(at);
        at += words * 8;
    }
    out.starts = reinterpret_cast<const std::uint32_t*>(at);
    out.spans = reinterpret_cast<const QuantizedSpan*>(out.starts + sizes.lists + 1);
    if (sizes.is_uniform) return end;
    at += padded(4 * (sizes.lists + 1 + sizes.spans));
    out.ranks = reinterpret_cast<const std::uint16_t*>(at);
    if (sizes.has_numbers) out.lists = out.ranks + words;
    return end;
}

/// Returns whether each number is larger than the one before it. Looks at all of them, several at a time.
bool are_ascending(std::span<const std::uint32_t> numbers)
{
    std::uint32_t wrong = 0;
    for (std::size_t k = 1; k < numbers.size(); ++k) wrong |= std::uint32_t(numbers[k - 1] >= numbers[k]);
    return wrong == 0;
}

bool is_consistent(const CellIntervals& list, const ListSizes& sizes)
{
    if (sizes.cells == 0) return true;
    // Each list has intervals, and the next one begins after it.
    if (list.starts[0] != 0 || list.starts[sizes.lists] != sizes.spans ||
        !are_ascending({list.starts, sizes.lists + 1}))
        return false;
    if (sizes.is_uniform) return sizes.cells == BoundsTile::cells;
    std::uint32_t marked = 0;
    for (std::size_t word = 0; word < words; ++word) {
        if (list.ranks[word] != marked) return false;
        marked += std::uint32_t(std::popcount(list.marks[word]));
    }
    return marked == sizes.cells &&
           (!sizes.has_numbers || std::all_of(list.lists, list.lists + sizes.cells,
                                              [&](std::uint16_t number) { return number < sizes.lists; }));
}

/// Returns whether all cells have the same intervals.
bool is_uniform(const CellList& list)
{
    const std::span<const Interval> first = list.of(0);
    if (list.spans.size() != first.size() * BoundsTile::cells) return false;
    for (std::size_t cell = 1; cell < BoundsTile::cells; ++cell)
        if (!std::ranges::equal(list.of(cell), first)) return false;
    return true;
}

class TilePacker {
public:
    explicit TilePacker(const LooseTile& tile) : tile_(tile)
    {
        double low = tile.bounds.spans[0].bottom, high = tile.bounds.spans[0].top;
        for (const Interval& span : tile.bounds.spans) {
            low = std::min(low, span.bottom);
            high = std::max(high, span.top);
        }
        head_.is_uniform = is_uniform(tile.bounds) && is_uniform(tile.solids);
        head_.quantum = std::max(least_quantum, (high - low) / steps);
        head_.base = low - 2 * head_.quantum;
        if (head_.is_uniform != 0) {
            head_.base = high - UniformArrays::top * head_.quantum;
            while (height(UniformArrays::top) < high) head_.base = std::nextafter(head_.base, high);
        }
        head_.slack = tile.slack + head_.quantum;
    }

    std::string pack()
    {
        out_.resize(sizeof head_);
        put_list(tile_.bounds, 2, head_.bound_cells, head_.bound_lists, head_.bounds, [&](const Interval& span) {
            return QuantizedSpan{down(span.bottom), up(span.top)};
        });
        put_list(tile_.solids, 1, head_.solid_cells, head_.solid_lists, head_.solids, [&](const Interval& span) {
            return QuantizedSpan{up(span.bottom), down(span.top)};
        });
        if (head_.is_uniform == 0) put_tops();
        std::memcpy(out_.data(), &head_, sizeof head_);
        return std::move(out_);
    }

private:
    double height(double value) const { return head_.base + value * head_.quantum; }
    std::uint16_t down(double z) const
    {
        double value = std::floor((z - head_.base) / head_.quantum);
        while (height(value) > z) --value;
        return std::uint16_t(std::clamp(value, 1.0, 65535.0));
    }
    std::uint16_t up(double z) const
    {
        double value = std::ceil((z - head_.base) / head_.quantum);
        while (height(value) < z) ++value;
        return std::uint16_t(std::clamp(value, 1.0, 65535.0));
    }

    template <class T>
    void put(const T& value)
    {
        out_.append(reinterpret_cast<const char*>(&value), sizeof value);
    }
    template <class T>
    void put_array(const std::vector<T>& values)
    {
        out_.append(reinterpret_cast<const char*>(values.data()), values.size() * sizeof(T));
    }
    void pad() { out_.resize(padded(out_.size()), '\0'); }

    void put_tops()
    {
        std::array<std::uint16_t, BoundsTile::cells> tops;
        for (std::size_t cell = 0; cell < BoundsTile::cells; ++cell) {
            const std::span<const Interval> spans = tile_.bounds.of(cell);
            tops[cell] = spans.empty() ? std::uint16_t{0} : up(spans.back().top);
        }
        put(tops);
    }

    /// Puts the intervals of all cells that have at least `least`, and sets the numbers of the head.
    template <class Quantize>
    void put_list(const CellList& list, std::uint32_t least, std::uint32_t& cells, std::uint32_t& lists,
                  std::uint32_t& intervals, const Quantize& quantize)
    {
        std::array<std::uint64_t, words> marks{};
        std::array<std::uint16_t, words> ranks{};
        std::vector<std::uint16_t> numbers;     // of the list of each marked cell
        std::vector<std::uint32_t> starts{0};   // of the lists
        std::vector<QuantizedSpan> spans, own;  // of all lists, and of the cell
        std::array<std::uint16_t, BoundsTile::cells> number_of;
        std::size_t all_spans = 0;
        const std::size_t stored_cells = head_.is_uniform != 0 ? 1 : BoundsTile::cells;
        for (std::size_t cell = 0; cell < stored_cells; ++cell) {
            if (cell % 64 == 0) ranks[cell / 64] = std::uint16_t(numbers.size());
            if (list.of(cell).size() < least) continue;
            own.clear();
            for (const Interval& span : list.of(cell)) own.push_back(quantize(span));
            all_spans += own.size();
            // Most cells have the list of the cell before them, or of the cell in the row before.
            const auto has_list_of = [&](std::size_t other) {
                if ((marks[other / 64] >> (other % 64) & 1) == 0) return false;
                const std::uint16_t number = number_of[other];
                return std::ranges::equal(
                    own, std::span(spans).subspan(starts[number], starts[number + 1] - starts[number]));
            };
            if (cell % BoundsTile::side != 0 && has_list_of(cell - 1)) {
                number_of[cell] = number_of[cell - 1];
            } else if (cell >= BoundsTile::side && has_list_of(cell - BoundsTile::side)) {
                number_of[cell] = number_of[cell - BoundsTile::side];
            } else {
                number_of[cell] = std::uint16_t(starts.size() - 1);
                spans.insert(spans.end(), own.begin(), own.end());
                starts.push_back(std::uint32_t(spans.size()));
            }
            marks[cell / 64] |= std::uint64_t{1} << (cell % 64);
            numbers.push_back(number_of[cell]);
        }
        cells = std::uint32_t(head_.is_uniform != 0 ? numbers.size() * BoundsTile::cells : numbers.size());
        if (cells == 0) return;
        // Numbers of lists take more memory than they save if few cells share a list.
        const bool has_numbers = head_.is_uniform == 0 && 2 * numbers.size() + 4 * (starts.size() + spans.size()) <
                                                              4 * (numbers.size() + 1 + all_spans);
        if (head_.is_uniform == 0 && !has_numbers) {
            starts.assign(1, 0);
            spans.clear();
            for (std::size_t cell = 0; cell < BoundsTile::cells; ++cell) {
                if (list.of(cell).size() < least) continue;
                for (const Interval& span : list.of(cell)) spans.push_back(quantize(span));
                starts.push_back(std::uint32_t(spans.size()));
            }
        }
        lists = has_numbers ? std::uint32_t(starts.size() - 1) : 0;
        intervals = std::uint32_t(spans.size());
        if (head_.is_uniform == 0) put(marks);
        put_array(starts);
        put_array(spans);
        pad();
        if (head_.is_uniform == 0) put(ranks);
        if (has_numbers) put_array(numbers);
        pad();
    }

    const LooseTile& tile_;
    BoundsHead head_{};
    std::string out_;
};

}  // namespace

BoundsTile::BoundsTile(std::string_view bytes, std::uint32_t bytes_version)
{
    if (bytes.empty()) return;
    const BoundsHead head = head_of(bytes, bytes_version);
    base = head.base;
    quantum = head.quantum;
    slack = head.slack;
    const char* at = bytes.data() + head_size(bytes_version);
    at = read_list(at, bound_sizes(head), bounds);
    at = read_list(at, solid_sizes(head), solids);
    tops = head.is_uniform != 0 ? uniform_arrays().tops.data() : reinterpret_cast<const std::uint16_t*>(at);
}

bool BoundsTile::is_consistent(std::string_view bytes, std::uint32_t bytes_version)
{
    if (bytes.size() < head_size(bytes_version)) return false;
    const BoundsHead head = head_of(bytes, bytes_version);
    for (const std::uint32_t count : {head.bound_cells, head.solid_cells, head.bound_lists, head.solid_lists})
        if (count > cells) return false;
    if (head.is_uniform > 1) return false;
    const std::size_t size = tile_size(head, bytes_version);
    if (bytes.size() < size || bytes.size() >= size + tile_alignment) return false;
    if (!std::isnormal(head.quantum) || !(head.quantum > 0) || !(head.slack >= 0) || !std::isfinite(head.base) ||
        !std::isfinite(head.base + 65535 * head.quantum))
        return false;
    const BoundsTile tile(bytes, bytes_version);
    return spawnfield::is_consistent(tile.bounds, bound_sizes(head)) &&
           spawnfield::is_consistent(tile.solids, solid_sizes(head));
}

void CellList::repeat_first()
{
    const std::vector<Interval> first(spans.begin(), spans.begin() + starts[1]);
    spans.clear();
    spans.reserve(first.size() * BoundsTile::cells);
    for (std::size_t cell = 0; cell < BoundsTile::cells; ++cell) {
        spans.insert(spans.end(), first.begin(), first.end());
        starts[cell + 1] = std::uint32_t(spans.size());
    }
}

std::string packed(const LooseTile& tile) { return tile.is_empty() ? std::string() : TilePacker(tile).pack(); }

}  // namespace spawnfield
