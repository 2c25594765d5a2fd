#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace spawnfield {

/// The UTF-8 mark that some spreadsheets write before the first line.
inline constexpr std::string_view byte_order_mark = "\xEF\xBB\xBF";

/// Returns the fields of one line, which comes without its line end. Quotes follow RFC 4180: they enclose a field, and
/// two quotes within it mean one. Spaces around a field are removed.
std::vector<std::string> csv_fields(std::string_view line);

/// Returns the fields of one line as they are written, with their quotes and spaces. They refer to `line`.
std::vector<std::string_view> raw_csv_fields(std::string_view line);

/// Returns whether all fields are numbers, as in a file without a header line. False if there are no fields.
bool are_numbers(const std::vector<std::string>& fields);

/// Returns a message, with the remedy, if semicolons or tabs separate the fields of the line; else "".
std::string separator_complaint(std::string_view line);

/// Returns the text as a CSV field: in quotes if it contains a comma, a quote or a line end.
std::string csv_quoted(std::string_view text);

}  // namespace spawnfield
