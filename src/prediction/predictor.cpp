#include "prediction/predictor.hpp"

#include <algorithm>
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

struct Registration {
    const char* name = nullptr;
    const char* title = nullptr;
    const char* summary = nullptr;
    PredictorRole role = PredictorRole::repair;
    core::SettingsTable (*table)() = nullptr;
    std::unique_ptr<Predictor> (*make)(PredictorContext, const core::Settings&) = nullptr;
    void (*check_model)(const Weights&) = nullptr;  ///< Of learned predictors.
};

struct NoSettings {
    static constexpr auto fields() { return std::make_tuple(); }
};

/// A predictor whose own settings are a `Config`.
template <auto make, class Config = NoSettings>
constexpr Registration registered(const char* name, const char* title, const char* summary,
                                  PredictorRole role, void (*check_model)(const Weights&) = nullptr) {
    return {name,
            title,
            summary,
            role,
            core::settings_table<PredictionConfig, Config>,
            [](PredictorContext context, const core::Settings& settings) {
                Config own;
                core::set_all(settings, "predictor ", context.config, own);
                if constexpr (std::is_same_v<Config, NoSettings>) {
                    return make(context);
                } else {
                    return make(context, own);
                }
            },
            check_model};
}

constexpr Registration registry[] = {
    registered<make_no_repair>("none", "no repair", "no repair: only vehicles whose newest report arrived",
                               PredictorRole::repair),
    registered<make_last_seen, LastSeenConfig>(
        "last_seen", "last seen", "vehicles stay where they were last seen", PredictorRole::repair),
    registered<make_dead_reckoning, DeadReckoningConfig>(
        "dead_reckoning", "dead reckoning", "vehicles go on at their reported speed along their route",
        PredictorRole::repair),
    registered<make_dead_reckoning_heading, DeadReckoningConfig>(
        "dead_reckoning_heading", "dead reckoning by heading", "vehicles go straight on by heading and speed",
        PredictorRole::repair),
    registered<make_kalman, KalmanConfig>(
        "kalman", "Kalman filter",
        "a constant-velocity Kalman filter per vehicle, P(d < r) from both covariances",
        PredictorRole::repair),
    registered<make_route_rule, RouteRuleConfig>(
        "route_rule", "route rule",
        "dead reckoning held by red lights and leaders, drawn to where surviving links can be",
        PredictorRole::repair),
    registered<make_car_following, CarFollowingConfig>(
        "car_following", "car-following twin",
        "vehicles drive on by the Intelligent Driver Model: behind leaders, before red, along their route",
        PredictorRole::repair),
    registered<make_common_neighbours, CommonNeighboursConfig>(
        "common_neighbours", "common neighbours", "links by the number of vehicles near both when last seen",
        PredictorRole::comparison),
    registered<make_logistic>("logistic", "logistic regression",
                              "logistic regression on distances, ages and speeds of a pair",
                              PredictorRole::comparison, check_logistic),
    registered<make_gradient_boosting>(
        "gradient_boosting", "gradient boosting",
        "boosted trees on what graphsage is given of a pair, of both ends and, summed, of their neighbours",
        PredictorRole::repair, check_gradient_boosting),
    registered<make_graphsage_as_published>("graphsage_as_published", "GraphSAGE, as published",
                                            "the dissertation's net on raw coordinates",
                                            PredictorRole::dissertation, check_graphsage_as_published),
    registered<make_graphsage_corrected>("graphsage_corrected", "GraphSAGE, corrected inputs",
                                         "the same architecture on inputs that carry distance and age",
                                         PredictorRole::comparison, check_graphsage_corrected),
    registered<make_gcn>("gcn", "GCN, corrected inputs",
                         "the corrected net with graph convolutions (Kipf and Welling) for GraphSAGE's",
                         PredictorRole::comparison, check_gcn),
    registered<make_gat>("gat", "GAT, corrected inputs",
                         "the corrected net with graph attention (Velickovic et al.) for GraphSAGE's",
                         PredictorRole::comparison, check_gat),
    registered<make_graphsage>("graphsage", "GraphSAGE, improved",
                               "the improved net: messages in route frames, motion head, calibrated links",
                               PredictorRole::repair, check_graphsage),
    registered<make_oracle, OracleConfig>(
        oracle_name, "oracle, which knows the truth",
        "knows the truth, spoiled by settings: the ceiling of every repair, and none itself",
        PredictorRole::ceiling),
};

const Registration& registration_of(const std::string& name) {
    for (const Registration& registration : registry) {
        if (name == registration.name) return registration;
    }
    const std::vector<std::string> names = predictor_names();
    const std::string near = core::nearest(name, names);
    throw core::InputError({"predictor", fmt::format("'{}' is not a predictor", name),
                            fmt::format("{}", fmt::join(names, ", ")),
                            near.empty() ? "" : fmt::format("Did you mean '{}'?", near)});
}

}  // namespace

std::vector<PredictorEntry> predictors() {
    std::vector<PredictorEntry> entries;
    for (const Registration& registration : registry) {
        entries.push_back({registration.name, registration.title, registration.summary, registration.role,
                           registration.check_model != nullptr});
    }
    return entries;
}

std::vector<std::string> predictor_names() {
    std::vector<std::string> names;
    for (const Registration& registration : registry) {
        names.emplace_back(registration.name);
    }
    return names;
}

std::string title_of(const std::string& name) {
    if (python::part_name_from(name)) return python::short_name(name) + " (Python)";
    return registration_of(name).title;
}

bool knows_truth(const std::string& name) {
    return std::ranges::any_of(registry, [&](const Registration& registration) {
        return name == registration.name && registration.role == PredictorRole::ceiling;
    });
}

std::vector<std::string> learned_predictor_names() {
    std::vector<std::string> names;
    for (const Registration& registration : registry) {
        if (registration.check_model != nullptr) names.emplace_back(registration.name);
    }
    return names;
}

core::SettingsTable settings_of(const std::string& name) {
    return registration_of(name).table();
}

void check_settings(const std::string& name, const core::Settings& settings, const std::string& where,
                    std::vector<core::Problem>& problems) {
    const auto append = [&](const core::SettingsTable& table, const core::Settings& some) {
        const std::vector<core::Problem> found = table.check(some, where + " ");
        problems.insert(problems.end(), found.begin(), found.end());
    };
    if (python::part_name_from(name))
        append(core::settings_table<PredictionConfig>(), parted_settings(settings).shared);
    for (const Registration& registration : registry) {
        if (name == registration.name) append(registration.table(), settings);
    }
}

void check_model(const std::string& name, const std::string& file) {
    for (const Registration& registration : registry) {
        if (name != registration.name) continue;
        if (registration.check_model == nullptr)
            throw core::InputError({file, fmt::format("{} is not learned and takes no model", name),
                                    fmt::format("{}", fmt::join(learned_predictor_names(), ", ")), ""});
        registration.check_model(read_model(name, file));
    }
}

void check_link_radius(const std::string& name, const std::string& file, double radius_m,
                       const std::string& where, std::vector<core::Problem>& problems) {
    // All shipped models were trained for the usual radius, among others.
    if (file.empty() && radius_m == RadiusRange{}.least_m) return;
    const auto learned = learned_predictor_names();
    if (std::ranges::find(learned, name) == learned.end()) return;
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
    return registration_of(name).make(context, settings);
}

}  // namespace clearway::prediction
