#include "training/detail/xgboost.hpp"

#include <array>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <string_view>

#include <nlohmann/json.hpp>
#include <xgboost/c_api.h>

namespace clearway::training::detail {
namespace {

void check(int code) {
    if (code != 0) throw std::runtime_error(std::string("XGBoost: ") + XGBGetLastError());
}

/// ln(1 + e^x) without overflow.
double softplus(double x) {
    return x > 0.0 ? x + std::log1p(std::exp(-x)) : std::log1p(std::exp(x));
}

/// Appends one tree, every parent before its children and the two children side by side.
class TreeWriter {
  public:
    void add(const nlohmann::json& tree) {
        const auto lefts = tree.at("left_children").get<std::vector<int>>();
        const auto rights = tree.at("right_children").get<std::vector<int>>();
        const auto inputs = tree.at("split_indices").get<std::vector<int>>();
        const auto numbers = tree.at("split_conditions").get<std::vector<float>>();
        root_.push_back(static_cast<float>(input_.size()));
        // A queue of nodes of XGBoost; its n-th entry becomes node `first + n`.
        std::vector<std::size_t> queue = {0};
        const std::size_t first = input_.size();
        for (std::size_t at = 0; at < queue.size(); ++at) {
            const std::size_t node = queue[at];
            const bool is_leaf = lefts[node] < 0;
            input_.push_back(is_leaf ? -1.0F : static_cast<float>(inputs[node]));
            threshold_.push_back(numbers[node]);
            left_.push_back(is_leaf ? 0.0F : static_cast<float>(first + queue.size()));
            if (is_leaf) continue;
            queue.push_back(static_cast<std::size_t>(lefts[node]));
            queue.push_back(static_cast<std::size_t>(rights[node]));
        }
    }

    std::vector<prediction::Tensor> tensors() const {
        const auto nodes = static_cast<std::uint32_t>(input_.size());
        return {{"base", {1}, {0.0F}},
                {"root", {static_cast<std::uint32_t>(root_.size())}, root_},
                {"input", {nodes}, input_},
                {"threshold", {nodes}, threshold_},
                {"left", {nodes}, left_}};
    }

  private:
    std::vector<float> root_, input_, threshold_, left_;
};

}  // namespace

void BoostingData::Free::operator()(void* handle) const {
    XGDMatrixFree(handle);
}

BoostingData::BoostingData(const std::vector<float>& inputs, std::size_t width,
                           const std::vector<float>& labels, const std::vector<float>& weights)
    : labels_(labels), weights_(weights) {
    DMatrixHandle handle = nullptr;
    check(XGDMatrixCreateFromMat(inputs.data(), labels.size(), width, std::numeric_limits<float>::quiet_NaN(),
                                 &handle));
    handle_.reset(handle);
    check(XGDMatrixSetFloatInfo(handle, "label", labels.data(), labels.size()));
    check(XGDMatrixSetFloatInfo(handle, "weight", weights.data(), weights.size()));
}

void Booster::Free::operator()(void* handle) const {
    XGBoosterFree(handle);
}

Booster::Booster(const BoostingData& train, const BoostingData& held_out,
                 const std::vector<Parameter>& parameters)
    : train_(train) {
    const std::array<DMatrixHandle, 2> data = {train.handle(), held_out.handle()};
    BoosterHandle handle = nullptr;
    check(XGBoosterCreate(data.data(), data.size(), &handle));
    handle_.reset(handle);
    const std::vector<Parameter> own = {{"objective", "binary:logistic"},
                                        {"base_score", "0.5"},
                                        {"tree_method", "hist"},
                                        {"nthread", "1"},
                                        {"verbosity", "0"}};
    for (const std::vector<Parameter>* const list : {&own, &parameters}) {
        for (const Parameter& parameter : *list)
            check(XGBoosterSetParam(handle, parameter.name.c_str(), parameter.value.c_str()));
    }
}

void Booster::grow() {
    check(XGBoosterUpdateOneIter(handle_.get(), grown_++, train_.handle()));
}

std::vector<float> Booster::logits(const BoostingData& data) const {
    constexpr int margin = 1;
    bst_ulong count = 0;
    const float* values = nullptr;
    check(XGBoosterPredict(handle_.get(), data.handle(), margin, 0, 0, &count, &values));
    return {values, values + count};
}

double Booster::loss(const BoostingData& data) const {
    const std::vector<float> logits = this->logits(data);
    double sum = 0.0;
    double weight = 0.0;
    for (std::size_t at = 0; at < logits.size(); ++at) {
        const double logit = logits[at];
        sum += data.weights()[at] * (softplus(logit) - data.labels()[at] * logit);
        weight += data.weights()[at];
    }
    return sum / weight;
}

std::vector<prediction::Tensor> Booster::tensors(std::size_t trees) const {
    bst_ulong length = 0;
    const char* text = nullptr;
    check(XGBoosterSaveModelToBuffer(handle_.get(), R"({"format": "json"})", &length, &text));
    const nlohmann::json model = nlohmann::json::parse(std::string_view(text, length));
    const nlohmann::json& grown = model.at("learner").at("gradient_booster").at("model").at("trees");
    TreeWriter writer;
    for (std::size_t at = 0; at < trees; ++at)
        writer.add(grown.at(at));
    return writer.tensors();
}

}  // namespace clearway::training::detail
