#include "prediction/shipped_models.hpp"

#include <algorithm>

#include <fmt/format.h>

#include "core/error.hpp"
#include "prediction/detail/model_texts.hpp"
#include "prediction/model_file.hpp"

namespace clearway::prediction {

Weights shipped_model(const std::string& predictor) {
    const auto models = detail::model_texts();
    const auto found = std::ranges::find(models, predictor, &detail::ModelText::predictor);
    if (found == models.end()) {
        throw core::InputError({"model of " + predictor, "this program carries no model for it",
                                fmt::format("{}", fmt::join(shipped_model_names(), ", ")),
                                "train one with `clearway links train` and name its file"});
    }
    return parse_weights(found->text, fmt::format("shipped model {}", predictor));
}

Weights model_of(const std::string& predictor, const std::string& file, double link_radius_m) {
    Weights weights = file.empty() ? shipped_model(predictor) : read_model(predictor, file);
    weights.require_link_radius(link_radius_m);
    return weights;
}

std::vector<std::string> shipped_model_names() {
    std::vector<std::string> names;
    for (const detail::ModelText& model : detail::model_texts()) {
        names.emplace_back(model.predictor);
    }
    return names;
}

}  // namespace clearway::prediction
