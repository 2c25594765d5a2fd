#include "base/csv.h"

#include "base/number.h"
#include "base/text.h"

#include <algorithm>

namespace spawnfield {
namespace {

/// Returns whether semicolons separate the fields of the line. Each comma must then be a decimal comma.
bool has_semicolons(std::string_view line)
{
    if (line.find(';') == std::string_view::npos) return false;
    for (std::size_t start = 0; start <= line.size();) {
        const std::size_t end = std::min(line.find(';', start), line.size());
        std::string field = trimmed(line.substr(start, end - start));
        start = end + 1;
        const std::size_t comma = field.find(',');
        if (comma == std::string::npos) continue;
        field[comma] = '.';
        double ignored = 0;
        if (!parse_number(field, ignored)) return false;
    }
    return true;
}

}  // namespace

std::vector<std::string> csv_fields(std::string_view line)
{
    std::vector<std::string> fields(1);
    bool quoted = false;
    for (std::size_t i = 0; i < line.size(); ++i) {
        if (line[i] == '"') {
            if (quoted && i + 1 < line.size() && line[i + 1] == '"')
                fields.back() += line[++i];
            else
                quoted = !quoted;
        } else if (line[i] == ',' && !quoted) {
            fields.emplace_back();
        } else {
            fields.back() += line[i];
        }
    }
    for (std::string& field : fields) field = trimmed(field);
    return fields;
}

std::vector<std::string_view> raw_csv_fields(std::string_view line)
{
    std::vector<std::string_view> fields;
    std::size_t start = 0;
    bool quoted = false;
    for (std::size_t i = 0; i < line.size(); ++i) {
        quoted ^= line[i] == '"';
        if (line[i] != ',' || quoted) continue;
        fields.push_back(line.substr(start, i - start));
        start = i + 1;
    }
    fields.push_back(line.substr(start));
    return fields;
}

bool are_numbers(const std::vector<std::string>& fields)
{
    double ignored = 0;
    return !fields.empty() && std::all_of(fields.begin(), fields.end(),
                                          [&](const std::string& field) { return parse_number(field, ignored); });
}

std::string separator_complaint(std::string_view line)
{
    if (has_semicolons(line))
        return "has fields separated by semicolons, needs commas, and points in decimals: tr ',;' '.,' < IN.csv > "
               "OUT.csv";
    const bool has_comma = line.find(',') != std::string_view::npos;
    return !has_comma && line.find('\t') != std::string_view::npos
               ? "has fields separated by tabs, needs commas: tr '\\t' ',' < IN.csv > OUT.csv"
               : "";
}

std::string csv_quoted(std::string_view text)
{
    if (text.find_first_of(",\"\n") == std::string_view::npos) return std::string(text);
    std::string out = "\"";
    for (const char c : text) out += c == '"' ? "\"\"" : std::string(1, c);
    return out + "\"";
}

}  // namespace spawnfield
