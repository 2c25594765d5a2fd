#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace spawnfield {

/// Before the first line of files that some spreadsheets write.
inline constexpr std::string_view byte_order_mark = "\xEF\xBB\xBF";

/// Fields of one line without its end (RFC 4180: quotes around a field, doubled within), spaces around them left out.
std::vector<std::string> csv_fields(std::string_view line);

/// Whether all fields are numbers, as in a file without a header. False for no fields.
bool are_numbers(const std::vector<std::string>& fields);

/// Why a line has no comma-separated fields, and what to do, if it is separated by semicolons or tabs; else empty.
std::string separator_complaint(std::string_view line);

/// A field: in quotes if it needs them.
std::string csv_quoted(std::string_view text);

}  // namespace spawnfield
