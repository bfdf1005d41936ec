#include "scenario/overrides.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <sstream>
#include <utility>

#include <fmt/format.h>

#include "core/error.hpp"
#include "scenario/detail/checks.hpp"
#include "scenario/detail/tables.hpp"

namespace clearway::scenario {
namespace {

using Problems = std::vector<core::Problem>;

/// What is wrong with the value of an override, whatever the scenario.
std::optional<core::Problem> problem_of(const Override& override, const Given& given) {
    const std::vector<std::string>& words = override.value.words;
    std::optional<core::Problem> problem;
    double number = 0.0;
    if (override.is_number()) {
        problem = core::set_member(override.value, given.text, given.where, number);
        if (problem) problem->cure.clear();
    } else if (!words.empty() && !core::contains(words, given.text)) {
        problem = core::Problem{given.where, fmt::format("\"{}\" is not known", given.text),
                                core::listed(words), ""};
    }
    return problem;
}

double number_in(const Given& given) {
    return core::number_from(given.text).value_or(0.0);
}

void apply_variant(const Override&, const Given& given, ScenarioConfig& config, Problems& problems) {
    if (given.text == core::name(Variant::standard)) return;
    if (!config.dense) {
        problems.push_back({given.where, fmt::format("scenario {} has no table [dense]", config.name), "",
                            "add the table, or use --density"});
        return;
    }
    config.demand.density *= config.dense->factor;
    config.demand.emergency = config.dense->emergency;
    config.time.warm_up_s = config.dense->warm_up_s;
    config.time.window_s = config.dense->window_s;
    for (const auto& [key, source] :
         {std::pair{"time.warm_up_s", "dense.warm_up_s"}, std::pair{"time.window_s", "dense.window_s"},
          std::pair{"demand.emergency", "dense.emergency"}, std::pair{"demand.density", "dense.factor"}})
        config.origins[key] = config.where(source);
    config.dense.reset();
    config.variant = Variant::dense;
}

/// Multiplies the density of the file and of the dense variant.
void apply_density(const Override& row, const Given& given, ScenarioConfig& config, Problems&) {
    config.density_factor = number_in(given);
    config.demand.density *= config.density_factor;
    config.origins[row.key] = given.where;
}

/// Divides the human and automated vehicles of a generated demand anew; measured demand has its own key for
/// the share.
void apply_share(const Override&, const Given& given, ScenarioConfig& config, Problems&) {
    const double share = number_in(given);
    if (config.measured) {
        config.measured->automated_share = share;
        return;
    }
    const int total = config.demand.human + config.demand.automated;
    config.demand.automated = static_cast<int>(std::lround(share * total));
    config.demand.human = total - config.demand.automated;
}

/// Sets the members that text such as `car=8,truck=2` names.
template <class Struct>
void set_members(const std::string& text, const std::string& where, Struct& target, Problems& problems) {
    core::Settings values;
    std::istringstream parts(text);
    for (std::string part; std::getline(parts, part, ',');) {
        const std::size_t equals = part.find('=');
        const std::string name = part.substr(0, equals);
        const std::string value = equals == std::string::npos ? "" : part.substr(equals + 1);
        if (!values.emplace(name, value).second)
            problems.push_back({where + " " + name, "is given twice", "each once", "Remove one"});
    }
    std::ranges::move(core::apply_settings(values, where + " ", target), std::back_inserter(problems));
}

/// Kinds that are not named get no weight.
template <class Kinds>
void set_kinds(const Given& given, Kinds& target, Problems& problems) {
    const std::size_t known = problems.size();
    Kinds kinds;
    core::for_each_field<Kinds>([&](const auto& field) { kinds.*field.member = 0.0; });
    set_members(given.text, given.where, kinds, problems);
    if (problems.size() == known) target = kinds;  // weights that were refused would be called 0
}

/// Incidents in place of those of the file.
void apply_incidents(const Override&, const Given& given, ScenarioConfig& config, Problems& problems) {
    config.incidents.clear();
    std::erase_if(config.origins, [](const auto& origin) { return origin.first.starts_with("incident["); });
    if (given.text == "none") return;
    if (given.text.empty())
        problems.push_back(
            {given.where, "is empty", "edge=ID, ... or none", "give the edge, or leave it out"});
    std::istringstream rows(given.text);
    for (std::string row; std::getline(rows, row, ';');) {
        config.origins[fmt::format("incident[{}]", config.incidents.size())] = given.where;
        const std::size_t known = problems.size();
        set_members(row, given.where, config.incidents.emplace_back(), problems);
        if (problems.size() > known)  // times that were refused would be compared as their defaults
            config.incidents.back().from_s = std::numeric_limits<double>::quiet_NaN();
    }
}

void apply_kinds(const Override& row, const Given& given, ScenarioConfig& config, Problems& problems) {
    set_kinds(given, config.traffic_kinds, problems);
    config.origins[row.key] = given.where;
}

void apply_emergency_kinds(const Override& row, const Given& given, ScenarioConfig& config,
                           Problems& problems) {
    set_kinds(given, config.emergency_kinds, problems);
    config.origins[row.key] = given.where;
    if (config.demand.emergency == 0)
        problems.push_back(
            {given.where, "has no effect, because demand.emergency is 0",
             "scenarios with demand.emergency above 0",
             "In a copy of the scenario (clearway scenario init), set demand.emergency or the kind "
             "of each [[emergency_trip]]"});
}

constexpr const char* by_scenario = "by scenario";

/// An override that has the type, range and meaning of a key, and sets it.
Override of_key(const char* name, const char* option, const char* key) {
    core::SettingInfo value = detail::key_info(key);
    value.name = name;
    value.preset = by_scenario;
    return {std::move(value), option, key, {key}};
}

Override density_factor() {
    Override density = of_key("density", "--density", "demand.density");
    density.value.preset = "1";
    density.value.doc =
        "Multiplies the density of the scenario, which 1 leaves as it is; measured demand "
        "has at most 1 in all";
    density.replaced.clear();
    density.apply = apply_density;
    return density;
}

Override automated_share() {
    Override share = of_key("automated_share", "--av-share", "measured.automated_share");
    share.replaced = {"measured.automated_share", "demand.human", "demand.automated"};
    share.apply = apply_share;
    return share;
}

/// One whose value is text that `apply` reads.
Override of_text(const char* name, const char* option, const char* key, const char* doc,
                 decltype(Override::apply) apply) {
    core::SettingInfo value;
    value.name = name;
    value.preset = by_scenario;
    value.doc = doc;
    return {std::move(value), option, key, {key}, apply};
}

Override dense_variant() {
    Override variant = of_text("variant", "--dense", "dense", "The scenario's dense variant", apply_variant);
    variant.replaced = {"demand.emergency", "time.warm_up_s", "time.window_s"};
    variant.value.words = core::words_of<Variant>();
    variant.is_flag = true;
    return variant;
}

/// The one list of overrides. To add one, add a line.
std::vector<Override> make_overrides() {
    return {
        dense_variant(),
        density_factor(),
        automated_share(),
        of_text("traffic_kinds", "--kinds", "kinds.traffic", "Weights of the kinds of traffic: car=8,truck=2",
                apply_kinds),
        of_text("emergency_kinds", "--emergency-kinds", "kinds.emergency",
                "Weights of the kinds of EVs: ambulance=2,police_car=1", apply_emergency_kinds),
        of_text("incident", "--incident", "incident",
                "Incidents in place of the scenario's: edge=ID,from_s=60,to_s=600; more after a semicolon; "
                "or none",
                apply_incidents),
        of_key("road_limit_kmh", "--road-limit", "limits.road_kmh"),
        of_key("warm_up_s", "--warm-up", "time.warm_up_s"),
        of_key("horizon_s", "--horizon", "time.horizon_s"),
        of_key("step_length_s", "--step-length", "time.step_length_s"),
        of_key("time_to_teleport_s", "--time-to-teleport", "time.time_to_teleport_s"),
        of_key("ignore_junction_blocker_s", "--ignore-junction-blocker", "time.ignore_junction_blocker_s"),
        of_key("siren_compliance", "--siren", "siren.compliance"),
        of_key("road_speed_factor", "--road-speed", "road.speed_factor"),
        of_key("friction", "--friction", "road.friction"),
        of_key("pedestrians_per_hour", "--pedestrians", "pedestrians.per_hour"),
        of_key("idm", "--idm", "drivers.idm"),
        of_key("car_following", "--car-following", "car_following.model"),
        of_key("driver_spread", "--driver-spread", "car_following.driver_spread"),
    };
}

const Override* find(const std::string& name) {
    for (const Override& override : overrides()) {
        if (override.value.name == name) return &override;
    }
    return nullptr;
}

}  // namespace

const std::vector<Override>& overrides() {
    static const std::vector<Override> all = make_overrides();
    return all;
}

bool is_override(const std::string& name) {
    return find(name) != nullptr;
}

bool replaces(const std::string& name, const std::string& value, const std::string& key) {
    const Override* const override = find(name);
    if (override == nullptr || (override->is_flag && value != override->value.words.back())) return false;
    return std::ranges::any_of(override->replaced, [&](const std::string& replaced) {
        return key == replaced || key.starts_with(replaced + ".");
    });
}

std::string density_words(const ScenarioConfig& config) {
    const double factor = config.density_factor;
    if (factor == 1.0 || factor == 0.0) return "";
    return fmt::format("density {:.3g} x {:.3g} = {:.3g}", config.demand.density / factor, factor,
                       config.demand.density);
}

void read_overrides(core::StrictTable& table, Options& options) {
    for (const Override& override : overrides()) {
        const std::string& name = override.value.name;
        std::optional<double> number;
        std::string text;
        if (override.is_number()) {
            table.number(name, number);
            if (number) text = fmt::format("{}", *number);
        } else {
            table.text(name, text);
        }
        if (text.empty()) continue;
        if (const auto problem = problem_of(override, {text, table.where(name)})) {
            table.problem(name, problem->what, problem->allowed, problem->cure);
        } else {
            options.set(name, text, table.where(name));
        }
    }
}

Options& Options::set(const std::string& name, const std::string& text, const std::string& where) {
    const Override* const known = find(name);
    const std::string& usual = known == nullptr ? name : known->option;
    overrides.insert_or_assign(name, Given{text, where.empty() ? usual : where});
    return *this;
}

double Options::number(const std::string& name, double otherwise) const {
    const auto found = overrides.find(name);
    return found == overrides.end() ? otherwise : core::number_from(found->second.text).value_or(otherwise);
}

void detail::apply(const Options& options, ScenarioConfig& config, Problems& problems) {
    std::vector<std::string> names;
    for (const Override& override : overrides()) {
        names.push_back(override.value.name);
        const auto found = options.overrides.find(override.value.name);
        if (found == options.overrides.end()) continue;
        const Given& given = found->second;
        if (auto problem = problem_of(override, given)) {
            problems.push_back(std::move(*problem));
        } else if (override.apply != nullptr) {
            override.apply(override, given, config, problems);
        } else if (auto wrong = set_key(config, override.key, given.text, given.where)) {
            problems.push_back(std::move(*wrong));
        }
    }
    for (const auto& [name, given] : options.overrides) {
        if (find(name) == nullptr) problems.push_back(core::unknown_setting(given.where, name, names));
    }
}

}  // namespace clearway::scenario
