#include "mesh_reader/collada_numbers.h"

#include "base/number.h"
#include "base/text.h"
#include "base/xml.h"

#include <spawnfield/error.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <unordered_map>
#include <vector>

namespace spawnfield {
namespace {

constexpr std::uint64_t most_index = 2147483647;

/// Calls visit(word) for each word of the element's text. White space separates words.
template <class Visit>
void for_each_word(const Xml& element, const Visit& visit)
{
    const auto is_space = [](char c) { return c == ' ' || c == '\t' || c == '\r' || c == '\n'; };
    const char* next = element.GetText();
    if (next == nullptr) return;
    for (;;) {
        while (is_space(*next)) ++next;
        if (*next == '\0') return;
        const char* const start = next;
        while (*next != '\0' && !is_space(*next)) ++next;
        visit(std::string_view(start, std::size_t(next - start)));
    }
}

/// Reads the whole text as a whole number of 0 .. 2147483647. Returns false if it is not one.
bool parse_index(std::string_view text, std::uint64_t& value)
{
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    return error == std::errc{} && end == text.data() + text.size() && value <= most_index;
}

/// Checks the numbers of a file, element by element.
class NumberCheck {
public:
    explicit NumberCheck(const std::string& file) : file_(file) {}

    void check(const Xml& root)
    {
        visit(root);
        for (const Xml* const accessor : accessors_) check_accessor(*accessor);
    }

private:
    void visit(const Xml& element)  // recursive: tinyxml2 limits the depth
    {
        if (is_named(element, "unit"))
            check_unit(element);
        else if (is_named(element, "float_array"))
            check_array(element, true);
        else if (is_named(element, "Name_array") || is_named(element, "IDREF_array"))
            check_array(element, false);
        else if (is_named(element, "accessor"))
            accessors_.push_back(&element);
        else if (is_named(element, "vertex_weights"))
            check_weights(element);
        else if (const Shape* const shape = shape_of(element))
            check_shape(element, *shape);
        else if (is_named(element, "node"))
            check_transforms(element);
        for (const Xml* child = element.FirstChildElement(); child != nullptr; child = child->NextSiblingElement())
            visit(*child);
    }

    struct Shape {
        const char* name;
        std::uint64_t corners;  ///< of each face; 0: any number
        std::uint64_t least;    ///< smallest number of corners in each <p>
    };
    static const Shape* shape_of(const Xml& element)
    {
        static constexpr std::array<Shape, 7> shapes{{{"triangles", 3, 0},
                                                      {"polylist", 0, 0},
                                                      {"polygons", 0, 1},
                                                      {"trifans", 0, 3},
                                                      {"tristrips", 0, 3},
                                                      {"lines", 0, 0},
                                                      {"linestrips", 0, 0}}};
        const auto found = std::find_if(shapes.begin(), shapes.end(),
                                        [&](const Shape& shape) { return is_named(element, shape.name); });
        return found == shapes.end() ? nullptr : &*found;
    }

    FileError error_at(const Xml& element, const std::string& what) const
    {
        return FileError(file_, "line " + std::to_string(element.GetLineNum()) + ": <" + element.Name() + "> " + what);
    }
    static std::string quoted(std::string_view word)
    {
        return "\"" + std::string(word.substr(0, 40)) + (word.size() > 40 ? "…\"" : "\"");
    }

    /// Returns the attribute as a whole number, or `usual` if the element does not have it.
    std::uint64_t whole(const Xml& element, const char* attribute, std::uint64_t usual,
                        std::uint64_t most = most_index) const
    {
        const std::string text = attribute_of(element, attribute);
        std::uint64_t value = usual;
        if (element.Attribute(attribute) != nullptr && (!parse_index(trimmed(text), value) || value > most))
            throw error_at(element, std::string("has ") + attribute + " " + quoted(text) +
                                        ", needs a whole number of 0 .. " + std::to_string(most));
        return value;
    }

    /// The count and the sum of an element's whole numbers.
    struct Indices {
        std::uint64_t count = 0, sum = 0;
    };
    /// Reads an element that contains only whole numbers >= `least`.
    Indices indices(const Xml& element, std::uint64_t least = 0) const
    {
        Indices found;
        for_each_word(element, [&](std::string_view word) {
            std::uint64_t value = 0;
            if (!parse_index(word, value) || value < least)
                throw error_at(element, "has " + quoted(word) + ", needs whole numbers of " + std::to_string(least) +
                                            " .. " + std::to_string(most_index) + " with spaces between");
            ++found.count;
            found.sum += value;
        });
        return found;
    }

    /// Checks an element that contains only numbers, and returns their count.
    std::uint64_t numbers(const Xml& element) const
    {
        std::uint64_t count = 0;
        for_each_word(element, [&](std::string_view word) {
            double value = 0;
            if (!parse_number(word, value))
                throw error_at(element, "has " + quoted(word) + ", needs numbers with spaces between");
            ++count;
        });
        return count;
    }

    void check_unit(const Xml& unit) const
    {
        const char* const text = unit.Attribute("meter");
        double metres = 0;
        if (text != nullptr && (!parse_number(trimmed(text), metres) || !(metres > 0) || !std::isfinite(metres)))
            throw error_at(unit, "has meter " + quoted(text) + ", needs a number > 0 (metres per unit)");
    }

    void check_array(const Xml& array, bool of_numbers)
    {
        std::uint64_t found = 0;
        if (of_numbers)
            found = numbers(array);
        else
            for_each_word(array, [&](std::string_view) { ++found; });
        if (const std::uint64_t count = whole(array, "count", 0); count != found)
            throw error_at(array, "has count " + std::to_string(count) + ", but contains " + std::to_string(found) +
                                      "; is the file damaged?");
        sizes_[attribute_of(array, "id")] = found;
    }

    void check_accessor(const Xml& accessor) const
    {
        const std::uint64_t count = whole(accessor, "count", 0), stride = whole(accessor, "stride", 1),
                            offset = whole(accessor, "offset", 0);
        std::uint64_t params = 0;
        for (const Xml* param = accessor.FirstChildElement("param"); param != nullptr;
             param = param->NextSiblingElement("param"))
            ++params;
        const std::string source = attribute_of(accessor, "source");
        const auto array = sizes_.find(source.empty() ? source : source.substr(1));
        if (array == sizes_.end() || count == 0) return;  // assimp reports an array that is missing
        const std::uint64_t needs = offset + (count - 1) * stride + std::max<std::uint64_t>(params, 1);
        if (needs > array->second)
            throw error_at(accessor, "needs " + std::to_string(needs) +
                                         " values (offset + (count - 1) stride + params) of " + quoted(source) +
                                         ", which has " + std::to_string(array->second));
    }

    void check_weights(const Xml& weights) const
    {
        for (const char* name : {"vcount", "v"})
            for (const Xml* child = weights.FirstChildElement(name); child != nullptr;
                 child = child->NextSiblingElement(name))
                numbers(*child);
    }

    void check_shape(const Xml& element, const Shape& shape) const
    {
        std::uint64_t stride = 1;
        for (const Xml* input = element.FirstChildElement("input"); input != nullptr;
             input = input->NextSiblingElement("input"))
            stride = std::max(stride, 1 + whole(*input, "offset", 0, 255));
        const std::uint64_t faces = whole(element, "count", 0);
        std::uint64_t wanted = faces * shape.corners * stride, found = 0;
        if (is_named(element, "polylist")) {
            Indices sizes;
            if (const Xml* const vcount = element.FirstChildElement("vcount")) sizes = indices(*vcount, 1);
            if (sizes.count != faces)
                throw error_at(element, "has count " + std::to_string(faces) + ", but " + std::to_string(sizes.count) +
                                            " numbers in <vcount>; is the file damaged?");
            wanted = sizes.sum * stride;
        }
        check_corners(element, shape, stride, found);
        const bool counted = shape.corners > 0 || is_named(element, "polylist");
        if (counted && found != wanted)
            throw error_at(element, "has " + std::to_string(found) + " numbers in <p>, needs " +
                                        std::to_string(wanted) + " for its " + std::to_string(faces) + " faces");
    }

    /// Checks all <p> and <h> within the element, also those within <ph>. Adds the numbers in <p> to `found`.
    void check_corners(const Xml& element, const Shape& shape, std::uint64_t stride, std::uint64_t& found) const
    {
        for (const Xml* child = element.FirstChildElement(); child != nullptr; child = child->NextSiblingElement()) {
            if (is_named(*child, "h")) indices(*child);
            if (is_named(*child, "p")) {
                const std::uint64_t count = indices(*child).count;
                if (count % stride != 0 || count / stride < shape.least)
                    throw error_at(*child, "has " + std::to_string(count) + " numbers, needs " +
                                               std::to_string(stride) + " for each corner and " +
                                               std::to_string(shape.least) + " corners or more");
                found += count;
            } else {
                check_corners(*child, shape, stride, found);
            }
        }
    }

    void check_transforms(const Xml& node) const
    {
        static constexpr std::array<std::pair<const char*, std::uint64_t>, 6> transforms{
            {{"matrix", 16}, {"translate", 3}, {"rotate", 4}, {"scale", 3}, {"lookat", 9}, {"skew", 7}}};
        for (const Xml* child = node.FirstChildElement(); child != nullptr; child = child->NextSiblingElement())
            for (const auto& [name, size] : transforms)
                if (is_named(*child, name))
                    if (const std::uint64_t found = numbers(*child); found != size)
                        throw error_at(*child,
                                       "has " + std::to_string(found) + " numbers, needs " + std::to_string(size));
    }

    const std::string& file_;
    std::unordered_map<std::string, std::uint64_t> sizes_;  ///< sizes of all arrays, by id
    std::vector<const Xml*> accessors_;                     ///< checked last: an array may come after its accessor
};

}  // namespace

void check_collada_numbers(const Xml& root, const std::string& file) { NumberCheck(file).check(root); }

}  // namespace spawnfield
