#pragma once

#include <span>
#include <string_view>

namespace clearway::prediction::detail {

struct ModelText {
    std::string_view predictor;
    std::string_view text;
};

/// The model files of the tree, put into the program when it was built (see CMakeLists.txt).
std::span<const ModelText> model_texts();

}  // namespace clearway::prediction::detail
