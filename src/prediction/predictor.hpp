#pragma once

#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "core/error.hpp"
#include "core/fields.hpp"
#include "core/random.hpp"
#include "core/settings.hpp"
#include "graph/proximity.hpp"
#include "prediction/candidates.hpp"
#include "roads/network.hpp"
#include "traffic/belief.hpp"
#include "traffic/observation.hpp"
#include "traffic/registry.hpp"

namespace clearway::prediction {

struct Weights;

/// A predictor's probabilities for all candidates at the last call, listed or not; for evaluation.
struct CandidateScores {
    const Scene* scene = nullptr;        ///< Rows of the candidates are those of the observation.
    std::span<const float> probability;  ///< One per candidate of `scene->candidates`, in the same order.
};

/// Repair: from what was reported to what is believed. Called at decisions, in order of time; reports that a
/// newer one overtook between two calls are not seen. Deterministic; keeps state and buffers; one thread.
/// Never sees the truth.
class Predictor {
  public:
    Predictor() = default;
    Predictor(const Predictor&) = delete;
    Predictor& operator=(const Predictor&) = delete;
    virtual ~Predictor() = default;

    virtual std::string_view name() const = 0;
    /// Fills `belief` (buffers reused): vehicles ordered by key, links by the candidate rule common to all
    /// predictors, each with its probability, own states, signals and roster copied from the observation.
    /// Where only places are wanted, there may be no links; all else, and every later answer, is the same.
    virtual void predict(const traffic::Observation& observation, traffic::BelievedGraph& belief,
                         Want want = Want::links) = 0;
    /// Of the last call of `predict`, which wanted links. Valid until the next one.
    virtual CandidateScores scores() const = 0;
};

/// Settings that all predictors share.
struct PredictionConfig {
    double link_threshold = 0.5;
    int reach_by_twin = 1;

    CandidateReach reach() const {
        return reach_by_twin != 0 ? CandidateReach::twins : CandidateReach::reported;
    }

    static constexpr void fields(const auto& table) {
        table(core::Field{"link_threshold", "1", &PredictionConfig::link_threshold, 0.0, 1.0,
                          "A candidate is listed as a link when its probability is at least this",
                          "even odds; F1 on validation seeds may favour another value"},
              core::Field{"reach_by_twin", "1", &PredictionConfig::reach_by_twin, 0, 1,
                          "1: pairs whose car-following twins are near are candidates, too",
                          "docs/reference/link-prediction.md; benchmark eval_v1 was frozen with 0"});
    }
};

/// What a predictor needs besides the observation. References outlive the predictor.
struct PredictorContext {
    const roads::Network& network;
    graph::LinkRules rules;
    std::string model_file;  ///< For the learned ones; empty: the model shipped with the program.
    PredictionConfig config = {};
    /// For predictors that spoil what they know (oracle.hpp); the others draw nothing at random.
    core::KeyedRandom random{core::StudySeed{}, core::Replication{}};
};

/// A registered predictor. Its settings are those that all predictors share, and its own (the field tables of
/// the predictors' headers); they win over `PredictorContext::config`.
struct PredictorEntry : traffic::Registered<Predictor, PredictorContext> {
    std::string title;  ///< What tables call it, as in mid-sentence: `GraphSAGE, corrected inputs`.
    void (*check_model)(const Weights&) = nullptr;  ///< Of learned predictors: throws core::InputError.
};

/// All registered predictors.
const traffic::Registry<PredictorEntry>& predictors();

/// The title of the predictor `name`, which may be one in Python; throws core::InputError for an unknown
/// name.
std::string title_of(const std::string& name);

/// Whether the predictor `name` is given the truth instead of reports. False for unknown names.
bool knows_truth(const std::string& name);

/// Appends a problem for every setting that the predictor `name` does not have and every value out of range;
/// `where` says where they are set. An unknown predictor gives no problem here.
void check_settings(const std::string& name, const core::Settings& settings, const std::string& where,
                    std::vector<core::Problem>& problems);

/// Throws core::InputError when `file` holds no model of the predictor `name` (model_file.hpp), or the
/// predictor takes none.
void check_model(const std::string& name, const std::string& file);

/// Appends the problems of a learned predictor whose model, the shipped one where `file` is empty, cannot be
/// read or was not trained for links of this radius; `where` says where the radius is set.
void check_link_radius(const std::string& name, const std::string& file, double radius_m,
                       const std::string& where, std::vector<core::Problem>& problems);

/// Throws core::InputError for an unknown name (naming the nearest), unfit settings, or an unreadable or
/// unfit model file. `settings` win over `context.config`.
std::unique_ptr<Predictor> make_predictor(const std::string& name, const PredictorContext& context,
                                          const core::Settings& settings = {});

}  // namespace clearway::prediction
