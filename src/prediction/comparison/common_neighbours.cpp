#include "prediction/comparison/common_neighbours.hpp"

#include <algorithm>
#include <string_view>
#include <vector>

#include "prediction/detail/pairwise.hpp"
#include "prediction/net_rows.hpp"

namespace clearway::prediction {
namespace {

using detail::PairwisePredictor;
using detail::RowBelief;

class CommonNeighbours final : public PairwisePredictor {
  public:
    CommonNeighbours(const PredictorContext& context, const CommonNeighboursConfig& config)
        : PairwisePredictor(context),
          intercept_(static_cast<float>(config.intercept)),
          slope_(static_cast<float>(config.slope)) {}
    std::string_view name() const override { return "common_neighbours"; }

  private:
    void score(const Scene& scene, const std::vector<RowBelief>&,
               std::vector<float>& probabilities) override {
        if (scene.candidates.size() == 0) return;
        build_graph(scene);
        for (std::size_t at = 0; at < scene.candidates.size(); ++at) {
            const auto shared = static_cast<float>(shared_neighbours(scene.candidates.rows[at]));
            probabilities[at] = probability_from_logit(intercept_ + slope_ * shared);
        }
    }

    void build_graph(const Scene& scene) {
        const Tracks& tracks = scene.tracks;
        builder_.build_all_pairs({tracks.last_x_m, tracks.last_y_m, tracks.vehicle_class}, rules().radius_m,
                                 near_);
        links_.clear();
        for (std::uint32_t row = 0; row < tracks.size(); ++row) {
            for (const std::uint32_t neighbour : near_.neighbours_of(row)) {
                links_.push_back({row, neighbour});
            }
        }
        for (const RowPair pair : scene.detected.rows) {
            links_.push_back(pair);
            links_.push_back({pair.right, pair.left});
        }
        std::ranges::sort(links_);
        links_.erase(std::unique(links_.begin(), links_.end()), links_.end());
        first_.assign(tracks.size() + 1, 0);
        for (const RowPair link : links_) {
            ++first_[link.left + 1];
        }
        for (std::size_t row = 0; row < tracks.size(); ++row) {
            first_[row + 1] += first_[row];
        }
    }

    std::size_t shared_neighbours(RowPair pair) const {
        std::size_t one = first_[pair.left];
        std::size_t other = first_[pair.right];
        std::size_t shared = 0;
        while (one < first_[pair.left + 1] && other < first_[pair.right + 1]) {
            const std::uint32_t a = links_[one].right;
            const std::uint32_t b = links_[other].right;
            if (a == b) ++shared;
            if (a <= b) ++one;
            if (b <= a) ++other;
        }
        return shared;
    }

    float intercept_;
    float slope_;
    graph::ProximityBuilder builder_;
    graph::ProximityGraph near_;
    std::vector<RowPair> links_;  ///< Both ways, ordered by (left, right).
    std::vector<std::uint32_t> first_;
};

}  // namespace

std::unique_ptr<Predictor> make_common_neighbours(const PredictorContext& context,
                                                  const CommonNeighboursConfig& config) {
    return std::make_unique<CommonNeighbours>(context, config);
}

}  // namespace clearway::prediction
