#pragma once

#include <cstddef>
#include <string>

namespace clearway::support {

inline std::string repeated(const std::string& text, std::size_t count) {
    std::string all;
    for (std::size_t row = 0; row < count; ++row)
        all += text;
    return all;
}

}  // namespace clearway::support
