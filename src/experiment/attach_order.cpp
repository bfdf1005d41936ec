#include "experiment/attach_order.hpp"

#include "core/files.hpp"
#include "core/json.hpp"
#include "experiment/condition_json.hpp"

namespace clearway::experiment {

std::string to_json(const AttachOrder& order) {
    core::Json object;
    object["host"] = order.host;
    object["port"] = order.port;
    object["network"] = order.network.string();
    object["automated"] = order.automated;
    object["emergency"] = order.emergency;
    object["study_seed"] = order.study_seed;
    object["condition"] = to_json(order.condition);
    object["output"] = order.output.string();
    return core::to_text(object);
}

AttachOrder read_attach_order(const std::filesystem::path& file) {
    const std::string where = file.string();
    const core::Json object = core::parse_object(core::read_file(file), where);
    AttachOrder order;
    std::vector<core::Problem> problems;
    core::ObjectReader reader(object, where, problems);
    std::string network;
    std::string output;
    reader.read("host", order.host);
    reader.read("port", order.port);
    reader.read("network", network);
    reader.read("automated", order.automated);
    reader.read("emergency", order.emergency);
    reader.read("study_seed", order.study_seed);
    order.condition = condition_from(reader.child("condition", core::Json::value_t::object),
                                     where + ": condition", problems);
    reader.read("output", output);
    if (!problems.empty()) throw core::InputError(problems);
    order.network = network;
    order.output = output;
    return order;
}

}  // namespace clearway::experiment
