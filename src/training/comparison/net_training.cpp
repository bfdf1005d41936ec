#include "training/comparison/net_training.hpp"

#include "training/detail/figures.hpp"

namespace clearway::training {

nlohmann::ordered_json NetResult::facts() const {
    return {{"arithmetic", detail::json_from(arithmetic())}};
}

prediction::Weights NetResult::weights() const {
    return prediction::net_weights(convolution, features, dimensions, state);
}

}  // namespace clearway::training
