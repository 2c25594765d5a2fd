#pragma once

#include <functional>

namespace tools {

/// Returns the mean of value(item) over all items; there must be at least one.
template <class Items, class Value = std::identity>
double mean(const Items& items, const Value& value = {})
{
    double sum = 0;
    for (const auto& item : items) sum += double(std::invoke(value, item));
    return sum / double(items.size());
}

/// Returns the sample variance (with n - 1); 0 for fewer than two items.
template <class Items, class Value = std::identity>
double sample_variance(const Items& items, const Value& value = {})
{
    if (items.size() < 2) return 0;
    const double centre = mean(items, value);
    double sum = 0;
    for (const auto& item : items)
        sum += (double(std::invoke(value, item)) - centre) * (double(std::invoke(value, item)) - centre);
    return sum / double(items.size() - 1);
}

}  // namespace tools
