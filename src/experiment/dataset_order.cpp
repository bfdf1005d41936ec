#include "experiment/dataset_order.hpp"

#include <algorithm>
#include <array>
#include <utility>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "core/error.hpp"
#include "core/files.hpp"

namespace clearway::experiment {
namespace {

constexpr std::array<std::string_view, 4> kind_names = {"published", "samples", "repair", "pair_samples"};
constexpr std::array<std::string_view, 2> pair_names = {"true_links", "candidates"};

template <class Enum, std::size_t count>
std::optional<Enum> find_name(const std::array<std::string_view, count>& names, std::string_view name) {
    const auto found = std::ranges::find(names, name);
    if (found == names.end()) return std::nullopt;
    return static_cast<Enum>(found - names.begin());
}

DatasetOrder order_from(const nlohmann::json& json) {
    DatasetOrder order;
    json.at("scenario").get_to(order.scenario);
    order.scenario_file = json.at("scenario_file").get<std::string>();
    order.network_folder = json.at("network_folder").get<std::string>();
    json.at("study_seed").get_to(order.study_seed);
    json.at("replication").get_to(order.replication);
    order.output = json.at("output").get<std::string>();
    order.kind = dataset_kind_from(json.at("kind").get<std::string>()).value();
    order.pairs = listed_pairs_from(json.at("pairs").get<std::string>()).value();
    json.at("feature_count").get_to(order.feature_count);
    json.at("failures").get_to(order.failures);
    json.at("interval_s").get_to(order.interval_s);
    json.at("exits").get_to(order.exits);
    return order;
}

}  // namespace

std::string_view name(DatasetKind kind) {
    return kind_names[static_cast<std::size_t>(kind)];
}

std::string_view name(ListedPairs pairs) {
    return pair_names[static_cast<std::size_t>(pairs)];
}

std::optional<DatasetKind> dataset_kind_from(std::string_view name) {
    return find_name<DatasetKind>(kind_names, name);
}

std::optional<ListedPairs> listed_pairs_from(std::string_view name) {
    return find_name<ListedPairs>(pair_names, name);
}

std::filesystem::path sample_file(const DatasetOrder& order, const std::string& failure,
                                  std::string_view ending) {
    return order.output / fmt::format("{}-{}{}-{:04}{}", order.scenario, failure,
                                      order.exits == "unknown" ? "-exits-unknown" : "", order.replication,
                                      ending);
}

std::string to_json(const DatasetOrder& order) {
    const nlohmann::json json = {{"scenario", order.scenario},
                                 {"scenario_file", order.scenario_file.string()},
                                 {"network_folder", order.network_folder.string()},
                                 {"study_seed", order.study_seed},
                                 {"replication", order.replication},
                                 {"output", order.output.string()},
                                 {"kind", name(order.kind)},
                                 {"pairs", name(order.pairs)},
                                 {"feature_count", order.feature_count},
                                 {"failures", order.failures},
                                 {"interval_s", order.interval_s},
                                 {"exits", order.exits}};
    return json.dump(2) + "\n";
}

DatasetOrder read_dataset_order(const std::filesystem::path& file) {
    try {
        return order_from(nlohmann::json::parse(core::read_file(file)));
    } catch (const nlohmann::json::exception& error) {
        throw core::InputError(
            {file.string(), error.what(), "a data set order as clearway dataset writes it", ""});
    } catch (const std::bad_optional_access&) {
        throw core::InputError({file.string(), "unknown kind or pairs",
                                "published, samples, repair, pair_samples; true_links, candidates", ""});
    }
}

}  // namespace clearway::experiment
