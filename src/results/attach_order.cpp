#include "results/attach_order.hpp"

#include "core/files.hpp"
#include "results/detail/condition_json.hpp"
#include "results/detail/json.hpp"

namespace clearway::results {

std::string to_json(const AttachOrder& order) {
    detail::Json object;
    object["host"] = order.host;
    object["port"] = order.port;
    object["network"] = order.network.string();
    object["automated"] = order.automated;
    object["emergency"] = order.emergency;
    object["study_seed"] = order.study_seed;
    object["condition"] = detail::to_json(order.condition);
    object["output"] = order.output.string();
    return detail::to_text(object);
}

AttachOrder read_attach_order(const std::filesystem::path& file) {
    const std::string where = file.string();
    const detail::Json object = detail::parse_object(core::read_file(file), where);
    AttachOrder order;
    std::vector<core::Problem> problems;
    detail::ObjectReader reader(object, where, problems);
    std::string network;
    std::string output;
    reader.read("host", order.host);
    reader.read("port", order.port);
    reader.read("network", network);
    reader.read("automated", order.automated);
    reader.read("emergency", order.emergency);
    reader.read("study_seed", order.study_seed);
    order.condition = detail::condition_from(reader.child("condition", detail::Json::value_t::object),
                                             where + ": condition", problems);
    reader.read("output", output);
    if (!problems.empty()) throw core::InputError(problems);
    order.network = network;
    order.output = output;
    return order;
}

}  // namespace clearway::results
