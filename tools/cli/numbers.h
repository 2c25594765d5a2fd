#pragma once

#include <spawnfield/error.h>
#include <spawnfield/query.h>

#include <cstdint>
#include <limits>
#include <string>
#include <vector>

namespace spawnfield::cli {

/// Returns the shortest text that reads back to the same double.
std::string number(double value);

/// Returns a number with six digits, for numbers that are not round.
std::string rounded(double value);

/// Returns "1 layer", "2 layers".
std::string counted(std::uint64_t count, const std::string& noun);

/// Reads finite numbers with `separator` between them. Throws ArgumentError, whose message ends with `advice`.
std::vector<double> parse_numbers(const std::string& option, const std::string& text, char separator = ',',
                                  const std::string& advice = "");

/// Reads "8GB", "500MB", "1.5 GiB", or a number of bytes, and returns bytes. Throws ArgumentError unless they are > 0.
double parse_size(const std::string& option, const std::string& text);

/// Two numbers, the smaller one first.
struct Limits {
    double low = -std::numeric_limits<double>::infinity(), high = std::numeric_limits<double>::infinity();
};

/// Reads "LOW:HIGH", "LOW:" or ":HIGH". Throws ArgumentError: its message says that the text needs `form`, or that
/// `lower` must be given first.
Limits parse_limits(const std::string& option, const std::string& text, const std::string& form,
                    const std::string& lower);

/// Reads "x0,y0,z0,x1,y1,z1", or with `flat_allowed` also "x0,y0,x1,y1", which means all heights. Throws ArgumentError.
Bounds parse_bounds(const std::string& option, const std::string& text, bool flat_allowed);

/// Returns bounds as parse_bounds() reads them: 6 numbers for 3 axes, 4 numbers for 2 axes.
std::string bounds_text(const Bounds& bounds, int axes);

/// Reads the value of --layers: all, top, bottom or N. Throws ArgumentError.
LayerChoice parse_layers(const std::string& text);

/// Return the value. Throw ArgumentError unless it is finite and, for the first one, positive.
double parse_positive(const std::string& option, double value);
double parse_finite(const std::string& option, double value, const std::string& unit);

/// Returns the error "--step is 0, needs > 0", for the caller to throw.
ArgumentError bad_value(const std::string& option, double value, const std::string& limit);

}  // namespace spawnfield::cli
