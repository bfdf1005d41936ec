#include "experiment/link_order.hpp"

#include <nlohmann/json.hpp>

#include "core/error.hpp"
#include "core/files.hpp"

namespace clearway::experiment {
namespace {

LinkPredictorOrder predictor_from(const nlohmann::json& json) {
    LinkPredictorOrder predictor;
    json.at("name").get_to(predictor.name);
    json.at("model_file").get_to(predictor.model_file);
    json.at("settings").get_to(predictor.settings);
    predictor.output = json.at("output").get<std::string>();
    return predictor;
}

LinkOrder order_from(const nlohmann::json& json) {
    LinkOrder order;
    json.at("scenario").get_to(order.scenario);
    order.scenario_file = json.at("scenario_file").get<std::string>();
    order.network_folder = json.at("network_folder").get<std::string>();
    json.at("study_seed").get_to(order.study_seed);
    json.at("replication").get_to(order.replication);
    order.work_folder = json.at("work_folder").get<std::string>();
    json.at("failures").get_to(order.failures);
    json.at("exits").get_to(order.exits);
    for (const nlohmann::json& predictor : json.at("predictors"))
        order.predictors.push_back(predictor_from(predictor));
    return order;
}

}  // namespace

std::string to_json(const LinkOrder& order) {
    nlohmann::json predictors = nlohmann::json::array();
    for (const LinkPredictorOrder& predictor : order.predictors) {
        predictors.push_back({{"name", predictor.name},
                              {"model_file", predictor.model_file},
                              {"settings", predictor.settings},
                              {"output", predictor.output.string()}});
    }
    const nlohmann::json json = {{"scenario", order.scenario},
                                 {"scenario_file", order.scenario_file.string()},
                                 {"network_folder", order.network_folder.string()},
                                 {"study_seed", order.study_seed},
                                 {"replication", order.replication},
                                 {"work_folder", order.work_folder.string()},
                                 {"failures", order.failures},
                                 {"exits", order.exits},
                                 {"predictors", predictors}};
    return json.dump(2) + "\n";
}

LinkOrder read_link_order(const std::filesystem::path& file) {
    try {
        return order_from(nlohmann::json::parse(core::read_file(file)));
    } catch (const nlohmann::json::exception& error) {
        throw core::InputError(
            {file.string(), error.what(), "a link order as clearway links evaluate writes it", ""});
    }
}

}  // namespace clearway::experiment
