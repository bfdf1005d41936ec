#include "prediction/predictor.hpp"

#include <algorithm>

#include <fmt/format.h>

#include "core/error.hpp"
#include "prediction/common_neighbours.hpp"
#include "prediction/kinematic.hpp"
#include "prediction/learned.hpp"
#include "prediction/logistic.hpp"
#include "prediction/planar.hpp"
#include "prediction/route_rule.hpp"

namespace clearway::prediction {
namespace {

struct Registration {
    const char* name;
    const char* summary;
    std::unique_ptr<Predictor> (*make)(const PredictorContext&);
};

constexpr Registration registry[] = {
    {"none", "no repair: only vehicles whose newest report arrived", make_no_repair},
    {"last_seen", "vehicles stay where they were last seen", make_last_seen},
    {"dead_reckoning", "vehicles go on at their reported speed along their route", make_dead_reckoning},
    {"dead_reckoning_heading", "vehicles go straight on by heading and speed",
     [](const PredictorContext& context) { return make_dead_reckoning_heading(context); }},
    {"kalman", "a constant-velocity Kalman filter per vehicle, P(d < r) from both covariances",
     [](const PredictorContext& context) { return make_kalman(context); }},
    {"route_rule", "dead reckoning held by red lights and leaders, drawn to where surviving links can be",
     make_route_rule},
    {"common_neighbours", "links by the number of vehicles near both when last seen",
     [](const PredictorContext& context) { return make_common_neighbours(context); }},
    {"logistic", "logistic regression on distances, ages and speeds of a pair", make_logistic},
    {"graphsage_as_published", "the dissertation's net on raw coordinates", make_graphsage_as_published},
    {"graphsage_corrected", "the same architecture on inputs that carry distance and age",
     make_graphsage_corrected},
    {"graphsage", "the improved net: messages in route frames, motion head, calibrated links",
     make_graphsage},
};

}  // namespace

std::vector<PredictorEntry> predictors() {
    std::vector<PredictorEntry> entries;
    for (const Registration& registration : registry) {
        entries.push_back({registration.name, registration.summary});
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

std::unique_ptr<Predictor> make_predictor(const std::string& name, const PredictorContext& context) {
    for (const Registration& registration : registry) {
        if (name == registration.name) return registration.make(context);
    }
    const std::vector<std::string> names = predictor_names();
    const std::string near = core::nearest(name, names);
    throw core::InputError({"predictor", fmt::format("'{}' is not a predictor", name),
                            fmt::format("{}", fmt::join(names, ", ")),
                            near.empty() ? "" : fmt::format("did you mean {}?", near)});
}

}  // namespace clearway::prediction
