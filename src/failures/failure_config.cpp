#include "failures/failure_config.hpp"

#include <algorithm>
#include <array>
#include <cassert>
#include <iterator>
#include <set>
#include <string_view>
#include <type_traits>

#include <fmt/format.h>

#include "core/error.hpp"
#include "core/settings.hpp"

namespace clearway::failures {
namespace {

/// Whether the configuration needs report rounds.
bool needs_rounds(const FailureConfig& config) {
    return config.loss_rate > 0.0 || config.dark_share > 0.0 || config.position_sigma_m > 0.0 ||
           config.speed_sigma_mps > 0.0 || config.latency_s > 0.0 || config.connected_share < 1.0 ||
           config.roadside_range_m > 0.0 || config.onboard_range_m > 0.0 ||
           config.link_detection_rate > 0.0 || config.heading_sigma_deg > 0.0 ||
           config.map_matching != MapMatching::exact || config.route_share < 1.0 ||
           config.signals_known != SignalsKnown::yes || config.emergency_sensor_range_m > 0.0;
}

/// With shorter outages, losses would follow each other less often than by chance.
void check_outages(double mean_s, double dark_share, double interval_s, const std::string& prefix,
                   std::vector<core::Problem>& problems) {
    const double least_s = interval_s / (1.0 - dark_share);
    if (dark_share == 0.0 || mean_s >= least_s - 1e-9) return;
    problems.push_back({prefix + "mean_outage_s",
                        fmt::format("{} is too short for a dark share of {}", mean_s, dark_share),
                        fmt::format("at least interval / (1 - dark share) = {:.4g} s", least_s),
                        "Use the loss rate for losses without bursts"});
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
    check_outages(channel.mean_outage_s, channel.dark_share, channel.interval_s, prefix, problems);
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
    check_outages(config.mean_outage_s, config.dark_share, interval_s, where + ".", problems);
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

/// Calls `visit` with each item of a list with commas, without the blanks around it.
template <class Visitor>
void for_each_item(std::string_view text, const Visitor& visit) {
    for (std::size_t comma = 0; comma != std::string_view::npos;) {
        comma = text.find(',');
        visit(trimmed(text.substr(0, comma)));
        text.remove_prefix(comma == std::string_view::npos ? text.size() : comma + 1);
    }
}

/// Reads presets and `FIELD=VALUE` items one after the other.
class ItemReader {
  public:
    void read(std::string_view item) {
        const std::size_t equals = item.find('=');
        if (equals == std::string_view::npos) return read_preset(item);
        const std::string name(trimmed(item.substr(0, equals)));
        if (!seen_.insert(name).second) problems.push_back({"failure." + name, "occurs twice", "once", ""});
        std::ranges::move(
            core::apply_settings({{name, std::string(trimmed(item.substr(equals + 1)))}}, "failure.", config),
            std::back_inserter(problems));
    }

    FailureConfig config;
    std::vector<core::Problem> problems;

  private:
    void read_preset(std::string_view item) {
        const std::vector<FailurePreset> presets = failure_presets();
        const auto preset = std::ranges::find(presets, item, &FailurePreset::name);
        if (preset == presets.end()) {
            const std::vector<std::string> names = core::texts_of(presets, &FailurePreset::name);
            problems.push_back({"failure", fmt::format("'{}' is not a failure preset", item),
                                core::listed(names), core::did_you_mean(std::string(item), names)});
            return;
        }
        const bool is_late = !seen_.empty() || (preset->kind == PresetKind::reports && !named_.empty());
        const bool is_second = core::contains(named_, preset->kind);
        if (is_late || is_second)
            problems.push_back({"failure", fmt::format("the preset '{}' after other items", item),
                                "one preset of reports, at the front; then one of loss and one of range of "
                                "requests; then fields",
                                "Give its fields instead"});
        named_.push_back(preset->kind);
        apply(*preset, config);
    }

    std::set<std::string> seen_;  ///< Fields.
    std::vector<PresetKind> named_;
};

/// A preset of reports, with the fields that differ from reports at 1 Hz that never fail. The heading error
/// of 5 degrees is assumed: course over ground of a satellite receiver in town traffic.
struct ReportPreset {
    const char* name;
    const char* summary;
    const char* fields;
};
constexpr std::array report_presets = {
    ReportPreset{"perfect", "every vehicle reports its exact state at every step", "report_interval_s=0"},
    ReportPreset{"A.1", "10 % of the reports lost independently", "loss_rate=0.1"},
    ReportPreset{"A.2", "20 % of the reports lost independently", "loss_rate=0.2"},
    ReportPreset{"A.3", "30 % of the reports lost independently", "loss_rate=0.3"},
    ReportPreset{"A.4", "40 % of the reports lost independently", "loss_rate=0.4"},
    ReportPreset{"A.5", "50 % of the reports lost independently", "loss_rate=0.5"},
    ReportPreset{"A.6", "60 % of the reports lost independently", "loss_rate=0.6"},
    ReportPreset{"A.7", "70 % of the reports lost independently", "loss_rate=0.7"},
    ReportPreset{"B5", "outages of 5 s on average, dark 30 % of the time", "dark_share=0.3,mean_outage_s=5"},
    ReportPreset{"B10", "outages of 10 s on average, dark 30 % of the time",
                 "dark_share=0.3,mean_outage_s=10"},
    ReportPreset{"B20", "outages of 20 s on average, dark 30 % of the time",
                 "dark_share=0.3,mean_outage_s=20"},
    ReportPreset{"C.link", "B10, half of the dark links still detected",
                 "dark_share=0.3,mean_outage_s=10,link_detection_rate=0.5"},
    ReportPreset{"C.range", "B10, half of the dark links still detected with their range, 1 m error",
                 "dark_share=0.3,mean_outage_s=10,link_detection_rate=0.5,detection=range,range_sigma_m=1"},
    ReportPreset{"D1", "white position noise of 1 m", "position_sigma_m=1"},
    ReportPreset{"D3", "white position noise of 3 m", "position_sigma_m=3"},
    ReportPreset{"D5", "white position noise of 5 m", "position_sigma_m=5"},
    ReportPreset{"DL2", "every report arrives 2 s late", "latency_s=2"},
    ReportPreset{"D3B10", "D3 and B10 together", "dark_share=0.3,mean_outage_s=10,position_sigma_m=3"},
    ReportPreset{"B40", "outages of 40 s on average, dark 30 % of the time",
                 "dark_share=0.3,mean_outage_s=40"},
    ReportPreset{"D3M", "D3 with heading errors of 5 degrees, lanes found by map matching",
                 "position_sigma_m=3,heading_sigma_deg=5,map_matching=nearest"},
    ReportPreset{"D5M", "D5 with heading errors of 5 degrees, lanes found by map matching",
                 "position_sigma_m=5,heading_sigma_deg=5,map_matching=nearest"},
    ReportPreset{"R50", "routes of half of the vehicles known", "route_share=0.5"},
    ReportPreset{"R0", "routes of emergency vehicles alone known", "route_share=0"},
    ReportPreset{"S0", "what signals show is not known", "signals_known=0"},
    ReportPreset{"mixed", "B20, D3M and R50 together",
                 "dark_share=0.3,mean_outage_s=20,position_sigma_m=3,heading_sigma_deg=5,"
                 "map_matching=nearest,route_share=0.5"},
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
    static const std::vector<FailurePreset> all = [] {
        std::vector<FailurePreset> presets;
        for (const ReportPreset& row : report_presets) {
            ItemReader reader;
            for_each_item(row.fields, [&](std::string_view item) { reader.read(item); });
            assert(reader.problems.empty());
            presets.push_back({row.name, row.summary, reader.config});
        }
        add_request_presets(presets);
        return presets;
    }();
    return all;
}

FailureConfig failure_from(const std::string& text) {
    ItemReader reader;
    for_each_item(text, [&](std::string_view item) { reader.read(item); });
    if (reader.problems.empty()) reader.problems = problems_of(reader.config, "failure");
    if (!reader.problems.empty()) throw core::InputError(std::move(reader.problems));
    return reader.config;
}

}  // namespace clearway::failures
