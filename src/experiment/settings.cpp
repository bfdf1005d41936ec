#include "experiment/settings.hpp"

#include <algorithm>
#include <filesystem>
#include <optional>
#include <utility>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "actuation/actuator_config.hpp"
#include "core/error.hpp"
#include "core/files.hpp"
#include "core/folder_name.hpp"
#include "drivers/config.hpp"
#include "experiment/code_parts.hpp"
#include "experiment/detail/request_checks.hpp"
#include "experiment/equipped_signals.hpp"
#include "failures/failure_config.hpp"
#include "policy/ask.hpp"
#include "policy/policy.hpp"
#include "prediction/predictor.hpp"
#include "python/part_name.hpp"

namespace clearway::experiment {
namespace {

constexpr const char* loop_name = "loop";
constexpr const char* failure_name = "failure";
constexpr const char* actuation_name = "actuation";
constexpr const char* siren_name = "siren";
constexpr const char* requests_name = "requests";
constexpr const char* privilege_name = "privilege";
/// Maximum length of a described name; longer ones are cut and end in digits of their hash.
constexpr std::size_t longest_name = 80;

/// The part of `equipped_setting` behind its component.
constexpr const char* equipped_field = "equipped";

/// The numbers of actuation, and the text that says which signals take part.
core::SettingsTable actuation_table() {
    core::SettingsTable table = core::settings_table<actuation::ActuatorConfig>();
    table.rows.push_back(
        {equipped_field,
         "",
         0.0,
         0.0,
         {},
         all_equipped,
         "Signals that take part in policies: ids or numbers (#7), comma-separated, `all` or "
         "`none`. The others receive no request and keep their programs",
         "all: as in all results that do not name it"});
    table.check = [](const core::Settings& settings, const std::string& where) {
        core::Settings numbers = settings;
        std::vector<core::Problem> problems;
        if (const auto equipped = numbers.extract(equipped_field))
            problems = check_equipped(equipped.mapped(), where + equipped_field);
        actuation::ActuatorConfig config;
        for (core::Problem& problem : core::apply_settings(numbers, where, config))
            problems.push_back(std::move(problem));
        return problems;
    };
    return table;
}

std::vector<Component> make_components() {
    std::vector<Component> all = {
        {loop_name, "The closed loop", core::settings_table<LoopConfig>()},
        {failure_name,
         "Sensors: override the named failure, whose own values may differ from the defaults here",
         core::settings_table<failures::FailureConfig>()}};
    for (const prediction::PredictorEntry& entry : prediction::predictors())
        all.push_back({entry.name, "Predictor: " + entry.summary, entry.table});
    for (const policy::PolicyEntry& entry : policy::policies()) {
        if (!entry.table.rows.empty()) all.push_back({entry.name, "Policy: " + entry.summary, entry.table});
    }
    all.push_back({actuation_name, "How leases are carried out: signal transitions and their limits",
                   actuation_table()});
    all.push_back({siren_name, "Human drivers who hear a siren: override what the scenario says",
                   core::settings_table<drivers::SirenConfig>()});
    all.push_back({requests_name, "Human drivers who do what a policy asks",
                   core::settings_table<drivers::RequestConfig>()});
    all.push_back(
        {privilege_name,
         "What the law allows emergency vehicles, in every condition: override what the scenario says",
         core::settings_table<drivers::PrivilegeConfig>()});
    return all;
}

const Component* component_named(const std::string& name) {
    const auto found = std::ranges::find(components(), name, &Component::name);
    return found == components().end() ? nullptr : &*found;
}

/// Full names of all settings of these components.
std::vector<std::string> full_names(const std::vector<std::string>& of) {
    std::vector<std::string> names;
    for (const Component& component : components()) {
        if (!core::contains(of, component.name)) continue;
        for (const core::SettingInfo& row : component.table.rows)
            names.push_back(component.name + "." + row.name);
    }
    return names;
}

std::vector<std::string> component_names() {
    return core::texts_of(components(), &Component::name);
}

/// Asks for the full name probably meant by a name without a component or with a wrong one: that of a
/// component of nearly this name, or else the first whose last part it is.
std::string question(const std::string& name, const std::vector<std::string>& of) {
    const std::vector<std::string> known = full_names(of);
    const auto& [component, last] = parted(name);
    const std::string near = component.empty() ? "" : core::nearest(component, of);
    const auto same = std::ranges::find_if(known, [&, &field = last](const std::string& full) {
        const auto& [owner, own] = parted(full);
        return own == field && (near.empty() || owner == near);
    });
    return core::did_you_mean(same != known.end() ? *same
                              : near.empty()      ? name
                                                  : near + "." + last,
                              known,
                              "`clearway list settings` shows them all; of a class in Python they are the "
                              "arguments of its __init__");
}

void check_model(const ConditionSpec& condition, const std::string& where,
                 std::vector<core::Problem>& problems) {
    if (condition.model_file.empty()) return;
    try {
        prediction::check_model(condition.predictor, condition.model_file);
        checked_model(condition);
    } catch (const core::InputError& error) {
        for (core::Problem problem : error.problems()) {
            problem.where = fmt::format("{}model: {}", where, problem.where);
            problems.push_back(std::move(problem));
        }
    }
}

/// Policies that place vehicles within their lane run in the sublane model alone.
void check_sublane(const ConditionSpec& condition, const std::string& where,
                   std::vector<core::Problem>& problems) {
    if (condition.traffic_model == TrafficModel::sublane) return;
    for (const std::string& policy : policies_with(condition, traffic::Trait::sublane_model))
        problems.push_back(
            {where + "policy",
             fmt::format("{} needs vehicles with a place within their lane, which traffic model \"{}\" does "
                         "not have",
                         policy, name(condition.traffic_model)),
             "traffic model \"sublane\"",
             "Run it with --traffic-model sublane, in a study file traffic_model = \"sublane\""});
}

void check_link_radius(const ConditionSpec& condition, const std::string& where,
                       std::vector<core::Problem>& problems) {
    const std::string name = std::string(loop_name) + ".link_radius_m";
    const auto set = condition.settings.find(name);
    const std::optional<double> radius_m =
        set == condition.settings.end() ? LoopConfig{}.link_radius_m : core::number_from(set->second);
    if (!radius_m) return;
    prediction::check_link_radius(condition.predictor, condition.model_file, *radius_m, where + name,
                                  problems);
}

/// The penalty is the device's own, and the way of an EV is chosen by one alone.
void check_rerouting(const ConditionSpec& condition, const std::string& where,
                     std::vector<core::Problem>& problems) {
    if (condition.rerouting_s > 0.0 && core::contains(condition.policies, "navigate"))
        problems.push_back(
            {where + "rerouting_s",
             fmt::format("is {:g}: SUMO's rerouting device and navigate would both choose the way",
                         condition.rerouting_s),
             "0 with navigate", "Leave it out, or give the device a condition of its own"});
    if (condition.rerouting_signal_penalty == 0.0 || condition.rerouting_s > 0.0) return;
    problems.push_back({where + "rerouting_signal_penalty",
                        fmt::format("is {:g}, and no vehicle has SUMO's rerouting device",
                                    condition.rerouting_signal_penalty),
                        "0 without rerouting_s", "Set rerouting_s, or leave it out"});
}

/// A part in Python is another process, which a copy of the run would share with it.
void check_copies(const ConditionSpec& condition, const std::string& where,
                  std::vector<core::Problem>& problems) {
    std::vector<std::string> parts = condition.policies;
    parts.push_back(condition.predictor);
    const bool has_code = std::ranges::any_of(
        parts, [](const std::string& part) { return python::part_name_from(part).has_value(); });
    const LoopConfig loop = loop_config(condition);
    if (loop.best_way_taken > 0 && loop.ways_tried == 0)
        problems.push_back({where + "loop.best_way_taken", "is 1, and no ways are tried",
                            "1 with loop.ways_tried above 0", "Set loop.ways_tried, or leave it out."});
    if (loop.holds_tried > 0 && condition.policies.empty())
        problems.push_back({where + "loop.holds_tried", "is set where no policy asks signals",
                            "0 without a policy", "Name a policy, or leave it out."});
    if (loop.holds_tried == 1)
        problems.push_back({where + "loop.holds_tried", "is 1, which tries no hold alone", "0, or 2 to 16",
                            "Set 8, for instance."});
    if (loop.best_hold_taken > 0 && loop.holds_tried == 0)
        problems.push_back({where + "loop.best_hold_taken", "is 1, and no holds are tried",
                            "1 with loop.holds_tried above 0", "Set loop.holds_tried, or leave it out."});
    if (loop.others_price > 0.0 && loop.best_hold_taken == 0)
        problems.push_back({where + "loop.others_price",
                            fmt::format("is {:g}, and no best hold is taken", loop.others_price),
                            "above 0 with loop.best_hold_taken = 1", "Set that, or leave it out."});
    if (!has_code) return;
    for (const char* const setting : {"loop.ways_tried", "loop.holds_tried", "loop.units_tried"}) {
        const auto tried = condition.settings.find(setting);
        if (tried == condition.settings.end() || tried->second == "0") continue;
        problems.push_back(
            {where + setting,
             tried->second + " copies of a run are to be made, and a part in Python cannot be copied",
             "0 with parts in Python", "Leave it out, or write the part in C++."});
    }
}

/// A lease that is not renewed must outlive two decisions. The policies lengthen their usual lease when the
/// period is long; a lease which somebody has set is not lengthened in silence.
void check_leases(const ConditionSpec& condition, const std::string& where,
                  std::vector<core::Problem>& problems) {
    const std::string period_name = std::string(loop_name) + ".policy_period_s";
    const auto set_period = condition.settings.find(period_name);
    const std::optional<double> period_s = set_period == condition.settings.end()
                                               ? LoopConfig{}.policy_period_s
                                               : core::number_from(set_period->second);
    if (!period_s) return;
    for (const auto& [name, value] : condition.settings) {
        const std::optional<double> lease_s = core::number_from(value);
        // 0 stands for two periods where it is allowed.
        if (!name.ends_with("lease_s") || !lease_s || *lease_s == 0.0 || *lease_s >= 2.0 * *period_s - 1e-9)
            continue;
        problems.push_back({where + name,
                            fmt::format("{} s is shorter than two policy periods, {} is {} s", value,
                                        period_name, *period_s),
                            fmt::format("at least {:g} s with this period", 2.0 * *period_s),
                            fmt::format("Set {} to {:g} or more, or {} to {:g} or less", name,
                                        2.0 * *period_s, period_name, *lease_s / 2.0)});
    }
}

/// The value that a condition sets, or an empty text.
std::string set_value(const ConditionSpec& condition, const std::string& name) {
    const auto found = condition.settings.find(name);
    return found == condition.settings.end() ? "" : found->second;
}

bool asks_linked(const ConditionSpec& condition, const std::string& part) {
    return set_value(condition, part + ".ask") == name(policy::Ask::linked);
}

/// Settings of links that decide whom a part asks: without `ask=linked` they have no effect, and relays need
/// links of automated vehicles with each other.
void check_ask(const ConditionSpec& condition, const std::string& where,
               std::vector<core::Problem>& problems) {
    const std::string relay_name = std::string(loop_name) + ".automated_links";
    for (const auto& [name, value] : condition.settings) {
        const auto [part, field] = parted(name);
        if (field != "ask_probability" && field != "ask_hops") continue;
        if (!asks_linked(condition, part)) {
            problems.push_back({where + name, fmt::format("has no effect, because {} asks everyone", part),
                                part + ".ask=linked",
                                fmt::format("Set {}.ask to linked, or remove {}", part, name)});
        } else if (field == "ask_hops" && core::number_from(value).value_or(1.0) > 1.0 &&
                   set_value(condition, relay_name) != "1") {
            problems.push_back(
                {where + name, fmt::format("is {}, but two automated vehicles are never linked", value),
                 "1, or more with " + relay_name + "=1", fmt::format("Set {} to 1", relay_name)});
        }
    }
}

/// A predictor that knows the truth reads no faulty reports; faults that would be ignored are refused.
void check_truth(const ConditionSpec& condition, const std::string& where,
                 std::vector<core::Problem>& problems) {
    if (!prediction::knows_truth(condition.predictor) ||
        !failures::reports_fail(failures::failure_from(condition.failure)))
        return;
    problems.push_back({where + "failure",
                        fmt::format("'{}' degrades reports, but {} does not use reports", condition.failure,
                                    condition.predictor),
                        "perfect, and fields of requests",
                        fmt::format("Degrade its knowledge with its own settings: clearway list settings {}",
                                    condition.predictor)});
}

/// `config` with what the condition sets of a component. Throws core::InputError for unknown settings.
template <class Config>
Config with_settings(const ConditionSpec& condition, const char* component, Config config) {
    core::set_all(core::settings_of(condition.settings, component),
                  fmt::format("condition {}: {}.", condition.name, component), config);
    return config;
}

/// `lead_s_12`; with the component if several settings share the last name.
std::string setting_word(const std::string& name, const std::string& value, const core::Settings& all) {
    const std::string last = parted(name).second;
    const auto alike =
        std::ranges::count_if(all, [&](const auto& other) { return parted(other.first).second == last; });
    return (alike > 1 ? name : last) + "_" + value;
}

}  // namespace

const std::vector<Component>& components() {
    static const std::vector<Component> all = make_components();
    return all;
}

std::vector<std::string> components_of(const ConditionSpec& condition) {
    if (condition.traffic_model == TrafficModel::free_flow) return {};
    std::vector<std::string> present = {loop_name, failure_name, condition.predictor, siren_name,
                                        privilege_name};
    if (!condition.policies.empty()) present.insert(present.end(), {actuation_name, requests_name});
    const std::vector<std::string> parts_present = parts_of(condition);
    present.insert(present.end(), parts_present.begin(), parts_present.end());
    std::vector<std::string> ordered;
    for (const Component& component : components()) {
        if (core::contains(present, component.name)) ordered.push_back(component.name);
    }
    const std::vector<std::string> parts = part_names(condition);
    ordered.insert(ordered.end(), parts.begin(), parts.end());
    return ordered;
}

std::vector<std::string> parts_of(const ConditionSpec& condition) {
    std::vector<std::string> parts;
    const auto add = [&](const std::string& part) {
        if (!core::contains(parts, part)) parts.push_back(part);
    };
    for (const std::string& name : condition.policies) {
        if (const policy::PolicyEntry* const known = policy::policies().find(name)) {
            std::ranges::for_each(known->components, add);
        } else {
            add(python::short_name(name));
        }
    }
    return parts;
}

std::pair<std::string, std::string> parted(const std::string& name) {
    const std::size_t dot = name.find('.');
    if (dot == std::string::npos) return {"", name};
    return {name.substr(0, dot), name.substr(dot + 1)};
}

void set(ConditionSpec& condition, const std::string& name, const std::string& value) {
    const auto [component, field] = parted(name);
    const std::string text = core::setting_text(value);
    if (component != failure_name) {
        condition.settings.insert_or_assign(name, text);
        return;
    }
    const std::string item = field + "=" + text;
    std::string failure;
    bool is_there = false;
    std::size_t begin = 0;
    while (begin <= condition.failure.size()) {
        const std::size_t comma = std::min(condition.failure.find(',', begin), condition.failure.size());
        const std::string old = condition.failure.substr(begin, comma - begin);
        const bool same = old.starts_with(field + "=");
        failure += (failure.empty() ? "" : ",") + (same ? item : old);
        is_there = is_there || same;
        begin = comma + 1;
    }
    condition.failure = is_there ? failure : failure + "," + item;
}

void set_model(ConditionSpec& condition, const std::string& file, const std::string& where) {
    if (!std::filesystem::is_regular_file(file))
        throw core::InputError({where, fmt::format("{} is not a file", file),
                                "a file of clearway links train or of torch.save",
                                "`clearway links train` writes one"});
    condition.model_file = std::filesystem::absolute(file).lexically_normal().string();
    condition.model_hash = core::content_hash(core::read_file(file));
}

std::string checked_model(const ConditionSpec& condition) {
    if (condition.model_file.empty()) return {};
    if (core::content_hash(core::read_file(condition.model_file)) != condition.model_hash)
        throw core::InputError({condition.model_file, "has changed since it was given as the model",
                                "content hash " + condition.model_hash,
                                "Restore that file, or begin a new study"});
    return condition.model_file;
}

std::vector<core::Problem> check_setting(const std::string& name, const std::string& value,
                                         const std::string& where, const std::vector<std::string>& parts) {
    const auto [component, field] = parted(name);
    const Component* const known = component_named(component);
    if (core::contains(parts, component)) return {};
    if (known == nullptr) {
        std::vector<std::string> all = component_names();
        // Of a part in Python any setting may be meant; its own are known where it is loaded.
        const std::string cure = !component.empty() && parts.size() == 1 && !field.empty()
                                     ? fmt::format("Did you mean '{}.{}'?", parts.front(), field)
                                     : question(name, all);
        all.insert(all.end(), parts.begin(), parts.end());
        return {{where + name, "is unknown",
                 "COMPONENT.NAME, the component being one of " + core::listed(all), cure}};
    }
    const std::vector<std::string> names = core::texts_of(known->table.rows, &core::SettingInfo::name);
    if (!core::contains(names, field)) return {core::unknown_setting(where + name, field, names)};
    return known->table.check({{field, value}}, where + component + ".");
}

bool is_environment(const std::string& component) {
    return component == siren_name || component == privilege_name;
}

bool reads_links(const ConditionSpec& condition) {
    return std::ranges::any_of(parts_of(condition), [&](const std::string& part) {
        return policy::policies().is(part, traffic::Trait::reads_links) || asks_linked(condition, part);
    });
}

std::vector<std::string> policies_with(const ConditionSpec& condition, traffic::Trait trait) {
    std::vector<std::string> names = parts_of(condition);
    std::erase_if(names, [&](const std::string& name) { return !policy::policies().is(name, trait); });
    return names;
}

std::vector<core::Problem> check_settings(const ConditionSpec& condition, const std::string& where) {
    std::vector<core::Problem> problems;
    const std::vector<std::string> present = components_of(condition);
    for (const auto& [name, value] : condition.settings) {
        const std::string component = parted(name).first;
        const bool is_known = component_named(component) != nullptr;
        if (is_known && !core::contains(present, component)) {
            problems.push_back(
                {where + name,
                 fmt::format("is a setting of {}, which the condition does not have", component),
                 present.empty() ? "none: each emergency vehicle is alone on the road"
                                 : "settings of " + core::listed(present),
                 question(name, present)});
            continue;
        }
        const std::vector<core::Problem> found = check_setting(name, value, where, part_names(condition));
        problems.insert(problems.end(), found.begin(), found.end());
    }
    if (const auto part = part_called(condition.predictor))
        prediction::check_settings(condition.predictor, predictor_settings(condition), where + *part,
                                   problems);
    check_sublane(condition, where, problems);
    check_rerouting(condition, where, problems);
    if (problems.empty()) {
        check_copies(condition, where, problems);
        check_leases(condition, where, problems);
        check_ask(condition, where, problems);
        detail::check_requests(condition, where, problems);
    }
    if (problems.empty()) check_truth(condition, where, problems);
    check_model(condition, where, problems);
    if (problems.empty()) check_link_radius(condition, where, problems);
    return problems;
}

std::string settings_text(const ConditionSpec& condition) {
    std::vector<std::string> words = core::texts_of(
        condition.settings, [](const auto& entry) { return entry.first + "=" + entry.second; });
    if (!condition.model_file.empty())
        words.push_back("model=" + std::filesystem::path(condition.model_file).filename().string());
    return fmt::format("{}", fmt::join(words, " "));
}

std::string described_name(const ConditionSpec& condition) {
    const ConditionSpec usual;
    std::vector<std::string> words = core::texts_of(
        condition.policies, [](const std::string& policy) { return python::short_name(policy); });
    if (condition.bluelight == traffic::BlueLight::on) words.emplace_back("bluelight");
    if (condition.rerouting_s > 0.0) words.push_back(fmt::format("rerouting_{:g}s", condition.rerouting_s));
    if (condition.rerouting_signal_penalty > 0.0)
        words.push_back(fmt::format("penalty_{:g}", condition.rerouting_signal_penalty));
    if (condition.dispatch != usual.dispatch) words.emplace_back(name(condition.dispatch));
    if (words.empty()) words.emplace_back("no_policy");
    if (condition.failure != usual.failure) words.push_back(condition.failure);
    if (condition.predictor != usual.predictor) words.push_back(python::short_name(condition.predictor));
    if (!condition.model_file.empty())
        words.push_back(std::filesystem::path(condition.model_file).stem().string());
    if (condition.traffic_model != usual.traffic_model) words.emplace_back(name(condition.traffic_model));
    if (condition.safety_checks != usual.safety_checks) words.emplace_back("unchecked");
    for (const auto& [name, value] : condition.settings)
        words.push_back(setting_word(name, value, condition.settings));
    std::string text = core::as_folder_name(fmt::format("{}", fmt::join(words, "_")));
    if (text.size() > longest_name) {
        constexpr std::size_t digits = 8;
        text = text.substr(0, longest_name - digits - 1) + "_" + core::content_hash(text).substr(0, digits);
    }
    return text;
}

core::Settings predictor_settings(const ConditionSpec& condition) {
    return core::settings_of(condition.settings, python::short_name(condition.predictor));
}

LoopConfig loop_config(const ConditionSpec& condition, const LoopConfig& usual) {
    return with_settings(condition, loop_name, usual);
}

actuation::ActuatorConfig actuator_config(const ConditionSpec& condition, actuation::ActuatorConfig usual) {
    ConditionSpec numbers = condition;
    numbers.settings.erase(equipped_setting);  // see equipped_signals
    return with_settings(numbers, actuation_name, usual);
}

traffic::SirenConfig siren_config(const ConditionSpec& condition, const traffic::SirenConfig& of_scenario) {
    traffic::SirenConfig siren = of_scenario;
    core::set_all(core::settings_of(condition.settings, siren_name),
                  fmt::format("condition {}: siren.", condition.name), siren);
    return siren;
}

drivers::RequestConfig request_config(const ConditionSpec& condition) {
    return with_settings(condition, requests_name, drivers::RequestConfig{});
}

drivers::PrivilegeConfig privilege_config(const ConditionSpec& condition,
                                          const traffic::PrivilegeConfig& of_scenario) {
    return with_settings(condition, privilege_name, of_scenario);
}

}  // namespace clearway::experiment
