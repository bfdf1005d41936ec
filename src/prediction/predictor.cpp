#include "prediction/predictor.hpp"

#include <type_traits>
#include <utility>

#include <fmt/format.h>

#include "core/settings.hpp"
#include "prediction/car_following.hpp"
#include "prediction/comparison/common_neighbours.hpp"
#include "prediction/comparison/logistic.hpp"
#include "prediction/comparison/published_nets.hpp"
#include "prediction/kinematic.hpp"
#include "prediction/learned.hpp"
#include "prediction/model_file.hpp"
#include "prediction/oracle.hpp"
#include "prediction/planar.hpp"
#include "prediction/python_predictor.hpp"
#include "prediction/route_rule.hpp"
#include "prediction/shipped_models.hpp"
#include "python/part_name.hpp"

namespace clearway::prediction {
namespace {

using traffic::Trait;

struct NoSettings {
    static constexpr void fields(const auto& table) { table(); }
};

/// A predictor whose own settings are a `Config`. One with `check_model` is learned.
template <auto make, class Config = NoSettings>
PredictorEntry registered(const char* name, const char* title, const char* summary,
                          std::vector<Trait> traits = {}, void (*check_model)(const Weights&) = nullptr) {
    if (check_model != nullptr) traits.push_back(Trait::learned);
    const auto make_with = [](const PredictorContext& context, const core::Settings& settings) {
        PredictorContext own_context = context;
        Config own;
        core::set_all(settings, "predictor ", own_context.config, own);
        if constexpr (std::is_same_v<Config, NoSettings>) {
            return make(own_context);
        } else {
            return make(own_context, own);
        }
    };
    return {{name, summary, std::move(traits), core::settings_table<PredictionConfig, Config>(), make_with},
            title,
            check_model};
}

}  // namespace

const traffic::Registry<PredictorEntry>& predictors() {
    static const traffic::Registry<PredictorEntry> registry(
        "predictor",
        {
            registered<make_no_repair>("none", "no repair",
                                       "no repair: only vehicles whose newest report arrived"),
            registered<make_last_seen, LastSeenConfig>("last_seen", "last seen",
                                                       "vehicles stay where they were last seen"),
            registered<make_dead_reckoning, DeadReckoningConfig>(
                "dead_reckoning", "dead reckoning",
                "vehicles continue at their reported speed along their route"),
            registered<make_dead_reckoning_heading, DeadReckoningConfig>(
                "dead_reckoning_heading", "dead reckoning by heading",
                "vehicles continue straight at their heading and speed"),
            registered<make_kalman, KalmanConfig>(
                "kalman", "Kalman filter",
                "a constant-velocity Kalman filter per vehicle, P(d < r) from both covariances"),
            registered<make_route_rule, RouteRuleConfig>(
                "route_rule", "route rule",
                "dead reckoning limited by red lights and leaders, corrected by surviving links"),
            registered<make_car_following, CarFollowingConfig>(
                "car_following", "car-following twin",
                "vehicles follow the Intelligent Driver Model along their route, behind leaders and before "
                "red lights"),
            registered<make_common_neighbours, CommonNeighboursConfig>(
                "common_neighbours", "common neighbours",
                "comparison: links by the number of vehicles near both when last seen",
                {Trait::compares_only}),
            registered<make_logistic>("logistic", "logistic regression",
                                      "comparison: regression on distances, ages and speeds of a pair",
                                      {Trait::compares_only}, check_logistic),
            registered<make_gradient_boosting>("gradient_boosting", "gradient boosting",
                                               "boosted trees on the inputs of graphsage: the pair, both "
                                               "vehicles, and sums over their neighbours",
                                               {}, check_gradient_boosting),
            registered<make_graphsage_as_published>("graphsage_as_published", "GraphSAGE, as published",
                                                    "dissertation: its net on raw coordinates",
                                                    {Trait::repeats_dissertation},
                                                    check_graphsage_as_published),
            registered<make_graphsage_corrected>(
                "graphsage_corrected", "GraphSAGE, corrected inputs",
                "comparison: the same architecture on inputs that carry distance and age",
                {Trait::compares_only}, check_graphsage_corrected),
            registered<make_gcn>(
                "gcn", "GCN, corrected inputs",
                "comparison: the corrected net with graph convolutions (Kipf and Welling) for GraphSAGE's",
                {Trait::compares_only}, check_gcn),
            registered<make_gat>(
                "gat", "GAT, corrected inputs",
                "comparison: the corrected net with graph attention (Velickovic et al.) for GraphSAGE's",
                {Trait::compares_only}, check_gat),
            registered<make_graphsage>(
                "graphsage", "GraphSAGE, improved",
                "the improved net: messages in route frames, motion head, calibrated links", {},
                check_graphsage),
            registered<make_oracle, OracleConfig>(
                oracle_name, "oracle, which knows the truth",
                "the truth, degraded by settings: an upper bound for every repair", {Trait::knows_truth}),
        });
    return registry;
}

std::string title_of(const std::string& name) {
    if (python::part_name_from(name)) return python::short_name(name) + " (Python)";
    return predictors().at(name).title;
}

bool knows_truth(const std::string& name) {
    return predictors().is(name, Trait::knows_truth);
}

void check_settings(const std::string& name, const core::Settings& settings, const std::string& where,
                    std::vector<core::Problem>& problems) {
    const auto append = [&](const core::SettingsTable& table, const core::Settings& some) {
        const std::vector<core::Problem> found = table.check(some, where + " ");
        problems.insert(problems.end(), found.begin(), found.end());
    };
    if (python::part_name_from(name))
        append(core::settings_table<PredictionConfig>(), parted_settings(settings).shared);
    if (const PredictorEntry* const entry = predictors().find(name)) append(entry->table, settings);
}

void check_model(const std::string& name, const std::string& file) {
    const PredictorEntry* const entry = predictors().find(name);
    if (entry == nullptr) return;
    if (entry->check_model == nullptr)
        throw core::InputError({file, fmt::format("{} is not learned and takes no model", name),
                                core::listed(predictors().names(Trait::learned)), ""});
    entry->check_model(read_model(name, file));
}

void check_link_radius(const std::string& name, const std::string& file, double radius_m,
                       const std::string& where, std::vector<core::Problem>& problems) {
    // All shipped models were trained for the usual radius, among others.
    if (file.empty() && radius_m == RadiusRange{}.least_m) return;
    if (!predictors().is(name, Trait::learned)) return;
    try {
        model_of(name, file, radius_m);
    } catch (const core::InputError& error) {
        for (core::Problem problem : error.problems()) {
            problem.where = fmt::format("{} with predictor {}", where, name);
            problems.push_back(std::move(problem));
        }
    }
}

std::unique_ptr<Predictor> make_predictor(const std::string& name, const PredictorContext& context,
                                          const core::Settings& settings) {
    if (python::part_name_from(name)) return make_python_predictor(context, name, settings);
    return predictors().at(name).make(context, settings);
}

}  // namespace clearway::prediction
