#pragma once

#include <cstdint>
#include <optional>

namespace clearway::metrics::detail {

/// The mean of what was added; empty without any.
struct Mean {
    double sum = 0.0;
    std::uint64_t count = 0;

    void add(const std::optional<double>& value) {
        if (!value) return;
        sum += *value;
        ++count;
    }
    void add(const Mean& other) {
        sum += other.sum;
        count += other.count;
    }
    std::optional<double> value() const {
        if (count == 0) return std::nullopt;
        return sum / static_cast<double>(count);
    }
};

}  // namespace clearway::metrics::detail
