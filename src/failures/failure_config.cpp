#include "failures/failure_config.hpp"

#include <algorithm>
#include <charconv>
#include <optional>
#include <string_view>
#include <type_traits>

#include <fmt/format.h>

#include "core/settings.hpp"

namespace clearway::failures {
namespace {

FailureConfig independent(double loss_rate) {
    FailureConfig config;
    config.loss_rate = loss_rate;
    return config;
}

FailureConfig bursty(double mean_outage_s) {
    FailureConfig config;
    config.dark_share = 0.3;
    config.mean_outage_s = mean_outage_s;
    return config;
}

FailureConfig detected(Detection detection, double range_sigma_m) {
    FailureConfig config = bursty(10.0);
    config.link_detection_rate = 0.5;
    config.detection = detection;
    config.range_sigma_m = range_sigma_m;
    return config;
}

FailureConfig noisy(FailureConfig config, double position_sigma_m) {
    config.position_sigma_m = position_sigma_m;
    return config;
}

/// Noisy reports that do not tell edge and lane.
FailureConfig matched(FailureConfig config, double position_sigma_m) {
    config.position_sigma_m = position_sigma_m;
    config.heading_sigma_deg = 5.0;  // Assumed: course over ground of a satellite receiver in town traffic.
    config.map_matching = MapMatching::nearest;
    return config;
}

FailureConfig with_routes(FailureConfig config, double route_share) {
    config.route_share = route_share;
    return config;
}

FailureConfig without_signals() {
    FailureConfig config;
    config.signals_known = SignalsKnown::no;
    return config;
}

FailureConfig perfect() {
    FailureConfig config;
    config.report_interval_s = 0.0;
    return config;
}

FailureConfig late(double latency_s) {
    FailureConfig config;
    config.latency_s = latency_s;
    return config;
}

/// Whether the configuration needs report rounds.
bool needs_rounds(const FailureConfig& config) {
    return config.loss_rate > 0.0 || config.dark_share > 0.0 || config.position_sigma_m > 0.0 ||
           config.speed_sigma_mps > 0.0 || config.latency_s > 0.0 || config.connected_share < 1.0 ||
           config.roadside_range_m > 0.0 || config.onboard_range_m > 0.0 ||
           config.link_detection_rate > 0.0 || config.heading_sigma_deg > 0.0 ||
           config.map_matching != MapMatching::exact || config.route_share < 1.0 ||
           config.signals_known != SignalsKnown::yes || config.emergency_sensor_range_m > 0.0;
}

/// The least mean outage, s: with shorter ones, losses would follow each other less often than by chance.
double least_outage_s(double interval_s, double dark_share) {
    return interval_s / (1.0 - dark_share);
}

/// Checks the settings of one channel, which start with `prefix`.
void check_channel(const ChannelConfig& channel, const ChannelConfig& usual, const std::string& prefix,
                   std::vector<core::Problem>& problems) {
    if (channel.propagation == Propagation::perfect) {
        if (channel == usual) return;
        problems.push_back({prefix + "propagation", "is perfect, but a setting of the same channel is given",
                            "sharp, los, nlos", "Give the propagation, or leave the other settings out"});
        return;
    }
    const double least_s = least_outage_s(channel.interval_s, channel.dark_share);
    if (channel.dark_share > 0.0 && channel.mean_outage_s < least_s - 1e-9)
        problems.push_back(
            {prefix + "mean_outage_s",
             fmt::format("{} is too short for a dark share of {}", channel.mean_outage_s, channel.dark_share),
             fmt::format("at least interval / (1 - dark share) = {:.4g} s", least_s),
             "Use the loss rate for losses without bursts"});
}

void check_ranges(const FailureConfig& config, const std::string& where,
                  std::vector<core::Problem>& problems) {
    core::for_each_field<FailureConfig>([&](const auto& field) {
        const auto& value = config.*field.member;
        if constexpr (std::is_arithmetic_v<std::remove_cvref_t<decltype(value)>>) {
            if (value >= field.minimum && value <= field.maximum) return;
            problems.push_back({fmt::format("{}.{}", where, field.name),
                                fmt::format("{} is out of range", value), core::range_text(field),
                                "Give another number, or leave it out"});
        }
    });
}

/// Checks settings that have no effect without another one.
void check_errors(const FailureConfig& config, const std::string& where,
                  std::vector<core::Problem>& problems) {
    const auto refuse = [&](const char* field, const char* what, const char* cure) {
        problems.push_back({fmt::format("{}.{}", where, field), what, "", cure});
    };
    if (config.position_correlation_s > 0.0 && config.position_sigma_m == 0.0)
        refuse("position_correlation_s", "no position error to correlate", "give position_sigma_m");
    if (config.speed_correlation_s > 0.0 && config.speed_sigma_mps == 0.0)
        refuse("speed_correlation_s", "no speed error to correlate", "give speed_sigma_mps");
    if (config.range_sigma_m > 0.0 && config.detection != Detection::range)
        refuse("range_sigma_m", "no range is detected", "give detection=range");
}

void check_together(const FailureConfig& config, const std::string& where,
                    std::vector<core::Problem>& problems) {
    const double interval_s = config.report_interval_s;
    if (interval_s > 0.0 && interval_s < 0.1) {
        problems.push_back({where + ".report_interval_s", fmt::format("{} is too short", interval_s),
                            "0.1 to 1 s, or 0 for a report at every step", ""});
    }
    if (interval_s == 0.0 && needs_rounds(config)) {
        problems.push_back({where + ".report_interval_s",
                            "is 0, which reports at every step, but failures are drawn for each report",
                            "0.1 to 1 s with failures, 0 for perfect sensing alone",
                            "Add report_interval_s=1 to the failure, or --set failure.report_interval_s=1"});
    }
    if (interval_s == 0.0 && config.dark_commands == DarkCommands::lost) {
        problems.push_back({where + ".dark_commands",
                            "is lost, but sensing is perfect: no report is ever lost",
                            "lost with failures of reports", "Add loss_rate or dark_share, or leave it out"});
    }
    check_errors(config, where, problems);
    const double least_s = least_outage_s(interval_s, config.dark_share);
    if (config.dark_share > 0.0 && config.mean_outage_s < least_s - 1e-9) {
        problems.push_back(
            {where + ".mean_outage_s",
             fmt::format("{} is too short for a dark share of {}", config.mean_outage_s, config.dark_share),
             fmt::format("at least report_interval_s / (1 - dark_share) = {:.4g} s", least_s),
             "use loss_rate for losses without bursts"});
    }
    if (config.occlusion == Occlusion::considered && config.onboard_range_m == 0.0 &&
        config.link_detection_rate == 0.0) {
        problems.push_back({where + ".occlusion", "considered, but no vehicle looks at others", "ignored",
                            "give onboard_range_m or link_detection_rate"});
    }
    check_channel(static_cast<const RequestChannel&>(config), RequestChannel{}, where + ".request_",
                  problems);
    check_channel(static_cast<const SignalRequestChannel&>(config), SignalRequestChannel{},
                  where + ".signal_request_", problems);
}

std::string_view trimmed(std::string_view text) {
    const std::size_t first = text.find_first_not_of(" \t");
    if (first == std::string_view::npos) return {};
    return text.substr(first, text.find_last_not_of(" \t") - first + 1);
}

/// Sets one field from its text. Returns what is allowed instead, or nothing when it was set.
std::optional<std::string> set(double& value, std::string_view text) {
    double number = 0.0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
    if (error != std::errc{} || end != text.data() + text.size()) return "a number";
    value = number;
    return std::nullopt;
}
std::optional<std::string> set(int& value, std::string_view text) {
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    if (error != std::errc{} || end != text.data() + text.size()) return "a whole number";
    return std::nullopt;
}
template <class Enum>
std::optional<std::string> set(Enum& value, std::string_view text) {
    const auto known = core::value_from<Enum>(text);
    if (!known) return core::spelling_list<Enum>();
    value = *known;
    return std::nullopt;
}

core::Problem unknown(std::string_view what, std::string_view name, const std::vector<std::string>& known) {
    const std::string near = core::nearest(std::string(name), known);
    return {"failure", fmt::format("'{}' is not a {}", name, what), fmt::format("{}", fmt::join(known, ", ")),
            near.empty() ? "" : fmt::format("Did you mean '{}'?", near)};
}

/// Presets in which a receiver does not know lanes, routes or signals.
void add_unknown_parts(std::vector<FailurePreset>& presets) {
    presets.push_back({"B40", "outages of 40 s on average, dark 30 % of the time", bursty(40.0)});
    for (const int metres : {3, 5}) {
        presets.push_back(
            {fmt::format("D{}M", metres),
             fmt::format("D{} with heading errors of 5 degrees, lanes found by map matching", metres),
             matched(FailureConfig{}, metres)});
    }
    presets.push_back({"R50", "routes of half of the vehicles known", with_routes(FailureConfig{}, 0.5)});
    presets.push_back({"R0", "routes of emergency vehicles alone known", with_routes(FailureConfig{}, 0.0)});
    presets.push_back({"S0", "what signals show is not known", without_signals()});
    presets.push_back({"mixed", "B20, D3M and R50 together", with_routes(matched(bursty(20.0), 3.0), 0.5)});
}

/// Reach of requests whose loss alone is of interest, m.
constexpr double unlimited_m = 10000.0;

void lose_requests(FailureConfig& config, double rate) {
    SignalRequestChannel& channel = config;
    if (channel.propagation == Propagation::perfect) {
        channel.propagation = Propagation::sharp;
        channel.range_m = unlimited_m;
    }
    channel.loss_rate = rate;
}

void limit_requests(FailureConfig& config, double range_m) {
    SignalRequestChannel& channel = config;
    channel.propagation = Propagation::los;
    channel.range_m = range_m;
}

/// What a preset changes in a configuration.
void apply(const FailurePreset& preset, FailureConfig& config) {
    const SignalRequestChannel& channel = preset.config;
    switch (preset.kind) {
        case PresetKind::reports:
            config = preset.config;
            break;
        case PresetKind::request_loss:
            lose_requests(config, channel.loss_rate);
            break;
        case PresetKind::request_range:
            limit_requests(config, channel.range_m);
            break;
    }
}

void add_request_presets(std::vector<FailurePreset>& presets) {
    for (int percent = 10; percent <= 90; percent += 10) {
        FailureConfig config;
        lose_requests(config, percent / 100.0);
        presets.push_back({fmt::format("Q{}", percent),
                           fmt::format("{} % of the messages between EVs and signals lost", percent), config,
                           PresetKind::request_loss});
    }
    for (const int metres : {75, 150, 300, 600, 10000}) {
        FailureConfig config;
        limit_requests(config, metres);
        const std::string range =
            metres >= 1000 ? fmt::format("{}km", metres / 1000) : fmt::format("{}m", metres);
        presets.push_back({"range_" + range,
                           fmt::format("half of the signals at {} m hear EVs, in line of sight", metres),
                           config, PresetKind::request_range});
    }
}

/// Reads `FIELD=VALUE` items one after the other.
class FieldReader {
  public:
    void read(std::string_view item) {
        const std::size_t equals = item.find('=');
        const std::string_view name = trimmed(item.substr(0, equals));
        const std::string_view value = trimmed(item.substr(equals + 1));
        std::vector<std::string> names;
        bool found = false;
        core::for_each_field<FailureConfig>([&](const auto& field) {
            names.emplace_back(field.name);
            if (name != field.name) return;
            found = true;
            auto allowed = set(config.*field.member, value);
            if (!allowed) return;
            if constexpr (std::is_arithmetic_v<std::remove_cvref_t<decltype(config.*field.member)>>)
                *allowed += fmt::format(" from {} to {}", field.minimum, field.maximum);
            problem(name, fmt::format("'{}' is not a valid value", value), *allowed);
        });
        if (!found) problems.push_back(unknown("field of a failure", name, names));
        if (std::ranges::find(seen_, name) != seen_.end()) problem(name, "occurs twice", "once");
        seen_.emplace_back(name);
    }

    void read_preset(std::string_view item) {
        const std::vector<FailurePreset> presets = failure_presets();
        const auto preset = std::ranges::find(presets, item, &FailurePreset::name);
        if (preset == presets.end()) {
            std::vector<std::string> names;
            for (const FailurePreset& one : presets)
                names.push_back(one.name);
            problems.push_back(unknown("failure preset", item, names));
            return;
        }
        const bool is_late = !seen_.empty() || (preset->kind == PresetKind::reports && !named_.empty());
        const bool is_second = std::ranges::find(named_, preset->kind) != named_.end();
        if (is_late || is_second)
            problems.push_back({"failure", fmt::format("the preset '{}' after other items", item),
                                "one preset of reports, at the front; then one of loss and one of range of "
                                "requests; then fields",
                                "Give its fields instead"});
        named_.push_back(preset->kind);
        apply(*preset, config);
    }

    FailureConfig config;
    std::vector<core::Problem> problems;

  private:
    void problem(std::string_view name, const std::string& what, const std::string& allowed) {
        problems.push_back({fmt::format("failure.{}", name), what, allowed, ""});
    }
    std::vector<std::string> seen_;  ///< Fields.
    std::vector<PresetKind> named_;
};

}  // namespace

bool reports_fail(const FailureConfig& config) {
    return needs_rounds(config);
}

std::vector<core::Problem> problems_of(const FailureConfig& config, const std::string& where) {
    std::vector<core::Problem> problems;
    check_ranges(config, where, problems);
    if (problems.empty()) check_together(config, where, problems);
    return problems;
}

std::vector<FailurePreset> failure_presets() {
    std::vector<FailurePreset> presets = {
        {"perfect", "every vehicle reports its exact state at every step", perfect()}};
    for (int tenths = 1; tenths <= 7; ++tenths) {
        presets.push_back({fmt::format("A.{}", tenths),
                           fmt::format("{} % of the reports lost independently", 10 * tenths),
                           independent(tenths / 10.0)});
    }
    for (const int seconds : {5, 10, 20}) {
        presets.push_back({fmt::format("B{}", seconds),
                           fmt::format("outages of {} s on average, dark 30 % of the time", seconds),
                           bursty(seconds)});
    }
    presets.push_back(
        {"C.link", "B10, half of the dark links still detected", detected(Detection::presence, 0.0)});
    presets.push_back({"C.range", "B10, half of the dark links still detected with their range, 1 m error",
                       detected(Detection::range, 1.0)});
    for (const int metres : {1, 3, 5}) {
        presets.push_back({fmt::format("D{}", metres), fmt::format("white position noise of {} m", metres),
                           noisy(FailureConfig{}, metres)});
    }
    presets.push_back({"DL2", "every report arrives 2 s late", late(2.0)});
    presets.push_back({"D3B10", "D3 and B10 together", noisy(bursty(10.0), 3.0)});
    add_unknown_parts(presets);
    add_request_presets(presets);
    return presets;
}

FailureConfig failure_from(const std::string& text) {
    FieldReader reader;
    std::string_view rest = text;
    for (bool more = true; more;) {
        const std::size_t comma = rest.find(',');
        const std::string_view item = trimmed(rest.substr(0, comma));
        more = comma != std::string_view::npos;
        if (more) rest.remove_prefix(comma + 1);
        if (item.find('=') != std::string_view::npos) {
            reader.read(item);
        } else {
            reader.read_preset(item);
        }
    }
    if (reader.problems.empty()) reader.problems = problems_of(reader.config, "failure");
    if (!reader.problems.empty()) throw core::InputError(std::move(reader.problems));
    return reader.config;
}

}  // namespace clearway::failures
