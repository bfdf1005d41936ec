#pragma once

#include <string>
#include <vector>

#include "core/error.hpp"
#include "core/fields.hpp"
#include "core/spellings.hpp"

namespace clearway::failures {

/// What is still known of a dark vehicle that a neighbour detects.
enum class Detection { presence, range };
/// Whether it is known when a vehicle leaves the network (detectors at every exit); if so, its last report is
/// dropped.
enum class Exits { known, unknown };
/// Whether a vehicle in between hides two others from each other's sensors.
enum class Occlusion { ignored, considered };
/// Whether a vehicle whose newest report was lost still receives commands: one radio for both ways.
enum class DarkCommands { received, lost };
/// Whether the radio of an emergency vehicle fails as those of other vehicles do.
enum class EmergencyDark { yes, no };
/// Who is in reach of a message (sensing/channel.hpp).
enum class Propagation {
    perfect,  ///< Everybody, at once, without loss.
    sharp,    ///< Everybody within the range.
    los,      ///< Path loss in line of sight, and shadowing.
    nlos,     ///< Path loss without line of sight, around buildings, and shadowing.
};
/// How a receiver finds a vehicle's place on the map: as the vehicle tells it, or from the reported position.
enum class MapMatching { exact, nearest };
/// Whether observations carry the letters that signals show.
enum class SignalsKnown { no, yes };

/// Spelling of each enumerator in files and on the command line.
constexpr core::Spellings<Detection, 2> spellings(Detection) {
    return {{{Detection::presence, "presence"}, {Detection::range, "range"}}};
}
constexpr core::Spellings<Exits, 2> spellings(Exits) {
    return {{{Exits::known, "known"}, {Exits::unknown, "unknown"}}};
}
constexpr core::Spellings<Occlusion, 2> spellings(Occlusion) {
    return {{{Occlusion::ignored, "ignored"}, {Occlusion::considered, "considered"}}};
}
constexpr core::Spellings<DarkCommands, 2> spellings(DarkCommands) {
    return {{{DarkCommands::received, "received"}, {DarkCommands::lost, "lost"}}};
}
constexpr core::Spellings<EmergencyDark, 2> spellings(EmergencyDark) {
    return {{{EmergencyDark::yes, "yes"}, {EmergencyDark::no, "no"}}};
}
constexpr core::Spellings<Propagation, 4> spellings(Propagation) {
    return {{{Propagation::perfect, "perfect"},
             {Propagation::sharp, "sharp"},
             {Propagation::los, "los"},
             {Propagation::nlos, "nlos"}}};
}
constexpr core::Spellings<MapMatching, 2> spellings(MapMatching) {
    return {{{MapMatching::exact, "exact"}, {MapMatching::nearest, "nearest"}}};
}
constexpr core::Spellings<SignalsKnown, 2> spellings(SignalsKnown) {
    return {{{SignalsKnown::no, "0"}, {SignalsKnown::yes, "1"}}};
}

/// How messages of emergency vehicles travel, as sensing/channel.hpp needs it.
struct ChannelConfig {
    Propagation propagation = Propagation::perfect;
    double range_m = 300.0;
    double loss_rate = 0.0;
    double dark_share = 0.0;
    double mean_outage_s = 10.0;
    double latency_s = 0.0;
    double interval_s = 0.5;
    int hops = 1;

    bool operator==(const ChannelConfig&) const = default;
};
/// The way to vehicles and the way to signals. They are bases of FailureConfig and not members, because a
/// field table lists members of its own struct.
struct RequestChannel : ChannelConfig {
    bool operator==(const RequestChannel&) const = default;
};
struct SignalRequestChannel : ChannelConfig {
    constexpr SignalRequestChannel() { range_m = 500.0; }
    bool operator==(const SignalRequestChannel&) const = default;
};

/// How sensors report, how requests reach vehicles and signals, and how both fail. The failures combine
/// freely; each is off by default.
/// docs/reference/sensing.md explains them.
struct FailureConfig : RequestChannel, SignalRequestChannel {
    double report_interval_s = 1.0;
    double loss_rate = 0.0;
    double dark_share = 0.0;
    double mean_outage_s = 10.0;
    double link_detection_rate = 0.0;
    Detection detection = Detection::presence;
    double range_sigma_m = 0.0;
    double link_detection_range_m = 1000.0;
    double position_sigma_m = 0.0;
    double position_correlation_s = 0.0;
    double speed_sigma_mps = 0.0;
    double speed_correlation_s = 0.0;
    double latency_s = 0.0;
    double connected_share = 1.0;
    double roadside_range_m = 0.0;
    double roadside_sigma_m = 1.0;
    double onboard_range_m = 0.0;
    double onboard_sigma_m = 0.5;
    Occlusion occlusion = Occlusion::ignored;
    DarkCommands dark_commands = DarkCommands::received;
    Exits exits = Exits::known;
    double forget_after_s = 300.0;
    double heading_sigma_deg = 0.0;
    MapMatching map_matching = MapMatching::exact;
    double route_share = 1.0;
    SignalsKnown signals_known = SignalsKnown::yes;
    double emergency_sensor_range_m = 0.0;
    double emergency_sensor_sigma_m = 0.5;
    EmergencyDark emergency_dark = EmergencyDark::yes;
    double way_loss_rate = 0.0;

    bool operator==(const FailureConfig&) const = default;

  private:
    /// A member of one channel as a member of this struct.
    template <class Way, class Member>
    static constexpr Member FailureConfig::*of(Member ChannelConfig::*member) {
        return static_cast<Member Way::*>(member);
    }
    static constexpr void report_fields(const auto& table) {
        using C = FailureConfig;
        using core::Field;
        table(
            Field{"report_interval_s", "s", &C::report_interval_s, 0.0, 1.0,
                  "Time between two reports of a vehicle: 0.1 to 1, or 0 for one at every step",
                  "1 Hz to 10 Hz as cooperative awareness messages (ETSI EN 302 637-2)"},
            Field{"loss_rate", "1", &C::loss_rate, 0.0, 1.0,
                  "Share of reports lost, each independently of the others", "off; presets A"},
            Field{"dark_share", "1", &C::dark_share, 0.0, 0.99,
                  "Share of time that a vehicle spends in outages (Gilbert-Elliott)", "off; presets B: 0.3"},
            Field{"mean_outage_s", "s", &C::mean_outage_s, 0.1, 3600.0, "Mean length of an outage",
                  "10 s assumed: a fault that a restart fixes"},
            Field{"link_detection_rate", "1", &C::link_detection_rate, 0.0, 1.0,
                  "Probability per report that a dark vehicle's link is still detected by the neighbour",
                  "off; presets C: 0.5"},
            Field{"detection", "", &C::detection, 0, 0, "What a detection reports",
                  "presence: the least information"},
            Field{"range_sigma_m", "m", &C::range_sigma_m, 0.0, 100.0, "Standard error of a detected range",
                  "off; preset C.range: 1 m"},
            Field{"link_detection_range_m", "m", &C::link_detection_range_m, 0.0, 1000.0,
                  "A link is detected only between vehicles nearer than this", "no limit"},
            Field{"position_sigma_m", "m", &C::position_sigma_m, 0.0, 100.0,
                  "Standard error of a reported position, along each axis", "off; presets D"},
            Field{"position_correlation_s", "s", &C::position_correlation_s, 0.0, 600.0,
                  "Correlation time of the position error (first-order process); 0 for white noise", "white"},
            Field{"speed_sigma_mps", "m/s", &C::speed_sigma_mps, 0.0, 20.0,
                  "Standard error of a reported speed", "off"},
            Field{"speed_correlation_s", "s", &C::speed_correlation_s, 0.0, 600.0,
                  "Correlation time of the speed error (first-order process); 0 for white noise", "white"},
            Field{"latency_s", "s", &C::latency_s, 0.0, 60.0,
                  "Time from measurement to arrival of every report", "off; preset DL2: 2 s"},
            Field{"connected_share", "1", &C::connected_share, 0.0, 1.0,
                  "Share of the human-driven vehicles that report at all; all other vehicles do",
                  "all of them, as the dissertation assumes"});
    }
    static constexpr void sight_fields(const auto& table) {
        using C = FailureConfig;
        using core::Field;
        table(
            Field{"roadside_range_m", "m", &C::roadside_range_m, 0.0, 1000.0,
                  "Roadside units at signals see every vehicle within this distance, equipped or not", "off"},
            Field{"roadside_sigma_m", "m", &C::roadside_sigma_m, 0.0, 100.0,
                  "Standard error of a position that a roadside unit sees, along each axis",
                  "1 m assumed: a camera on a mast"},
            Field{"onboard_range_m", "m", &C::onboard_range_m, 0.0, 1000.0,
                  "Automated and emergency vehicles that report also report the vehicles that they see "
                  "within this distance",
                  "off"},
            Field{"onboard_sigma_m", "m", &C::onboard_sigma_m, 0.0, 100.0,
                  "Standard error of a position seen from a vehicle, along each axis",
                  "0.5 m assumed: lidar or radar, with the observer's own error"},
            Field{"occlusion", "", &C::occlusion, 0, 0,
                  "Whether a vehicle in between hides others from on-board sensors and link detection",
                  "ignored: presets C have none"});
    }
    static constexpr void knowledge_fields(const auto& table) {
        using C = FailureConfig;
        using core::Field;
        table(
            Field{
                "dark_commands", "", &C::dark_commands, 0, 0,
                "Whether a vehicle whose newest report was lost still receives commands: one radio for both "
                "ways, whatever the channel of requests",
                "received: the sensor fails, not the radio"},
            Field{"exits", "", &C::exits, 0, 0, "Whether it is known when a vehicle leaves the network",
                  "known: the frozen benchmark reports both"},
            Field{"forget_after_s", "s", &C::forget_after_s, 1.0, 86400.0,
                  "Age at which the last report of a silent vehicle is dropped",
                  "300 s: with a mean of 20 s, fewer than one outage in a million lasts longer"},
            Field{"heading_sigma_deg", "deg", &C::heading_sigma_deg, 0.0, 90.0,
                  "Standard error of a reported heading, white", "off; presets D3M and D5M: 5"},
            Field{"map_matching", "", &C::map_matching, 0, 0,
                  "How a receiver finds edge, lane and place on the lane: as the vehicle tells them, or from "
                  "reported position and heading",
                  "exact: a vehicle is assumed to know its lane"},
            Field{"route_share", "1", &C::route_share, 0.0, 1.0,
                  "Share of the human-driven and automated vehicles that report their route; emergency "
                  "vehicles do",
                  "all of them; preset R50: 0.5"},
            Field{"signals_known", "", &C::signals_known, 0, 0,
                  "0: observations do not tell what signals show", "1: signals are infrastructure"},
            Field{
                "emergency_sensor_range_m", "m", &C::emergency_sensor_range_m, 0.0, 1000.0,
                "Emergency vehicles see every vehicle within this distance that no third one hides, without "
                "any message",
                "off; 80 m: a car's radar"},
            Field{"emergency_sensor_sigma_m", "m", &C::emergency_sensor_sigma_m, 0.0, 100.0,
                  "Standard error of a position that an emergency vehicle sees, along each axis",
                  "0.5 m assumed, as on-board sensors"},
            Field{"emergency_dark", "", &C::emergency_dark, 0, 0,
                  "Whether reports and radios of emergency vehicles fail as those of other vehicles do",
                  "yes: the frozen presets treat all vehicles alike"},
            Field{"way_loss_rate", "1", &C::way_loss_rate, 0.0, 1.0,
                  "Share of the other ways (`take_route`) that do not reach the emergency vehicle for which "
                  "they are found, each independently",
                  "0: found on board; above it, by a centre that tells the crew"});
    }
    static constexpr void request_fields(const auto& table) {
        using C = ChannelConfig;
        using Way = RequestChannel;
        using core::Field;
        table(
            Field{"request_propagation", "", of<Way>(&C::propagation), 0, 0,
                  "Which vehicles hear the requests of an emergency vehicle",
                  "perfect: every vehicle; older conditions had no channel"},
            Field{
                "request_range_m", "m", of<Way>(&C::range_m), 1.0, 10000.0,
                "sharp: they are heard within this distance; los and nlos: half of them are at this distance",
                "300 m: usual for vehicle radios in streets; with 50 m it is the link radius"},
            Field{"request_loss_rate", "1", of<Way>(&C::loss_rate), 0.0, 1.0,
                  "Share of these messages lost by a receiver in reach, each independently", "off"},
            Field{"request_dark_share", "1", of<Way>(&C::dark_share), 0.0, 0.99,
                  "Share of time that a vehicle's receiver spends in outages (Gilbert-Elliott)", "off"},
            Field{"request_mean_outage_s", "s", of<Way>(&C::mean_outage_s), 0.1, 3600.0,
                  "Mean length of an outage of a receiver", "as of reports"},
            Field{"request_latency_s", "s", of<Way>(&C::latency_s), 0.0, 60.0,
                  "Time from a decision to its arrival, for each hop", "off"},
            Field{"request_interval_s", "s", of<Way>(&C::interval_s), 0.1, 60.0,
                  "Time between two messages of an emergency vehicle; all requests of a decision are one "
                  "message",
                  "0.5 s: every decision at the usual period"},
            Field{"request_hops", "1", of<Way>(&C::hops), 1, 5,
                  "Number of hops of a message: above 1, automated vehicles that receive it relay it",
                  "1: no relays"});
    }
    static constexpr void signal_request_fields(const auto& table) {
        using C = ChannelConfig;
        using Way = SignalRequestChannel;
        using core::Field;
        table(Field{"signal_request_propagation", "", of<Way>(&C::propagation), 0, 0,
                    "Which signals hear the requests of an emergency vehicle",
                    "perfect: every signal; older conditions had no channel"},
              Field{"signal_request_range_m", "m", of<Way>(&C::range_m), 1.0, 10000.0,
                    "As request_range_m, to the middle of a signal's stop lines",
                    "500 m assumed: a receiver on a mast"},
              Field{"signal_request_loss_rate", "1", of<Way>(&C::loss_rate), 0.0, 1.0,
                    "Share of these messages lost by a signal in reach, each independently", "off"},
              Field{"signal_request_dark_share", "1", of<Way>(&C::dark_share), 0.0, 0.99,
                    "Share of time that a signal's receiver spends in outages (Gilbert-Elliott)", "off"},
              Field{"signal_request_mean_outage_s", "s", of<Way>(&C::mean_outage_s), 0.1, 3600.0,
                    "Mean length of an outage of a signal's receiver", "as of reports"},
              Field{"signal_request_latency_s", "s", of<Way>(&C::latency_s), 0.0, 60.0,
                    "Time from a decision to its arrival at the signal", "off"},
              Field{"signal_request_interval_s", "s", of<Way>(&C::interval_s), 0.1, 60.0,
                    "Time between two messages of an emergency vehicle to signals", "as of requests"});
    }

  public:
    static constexpr void fields(const auto& table) {
        report_fields(table);
        sight_fields(table);
        knowledge_fields(table);
        request_fields(table);
        signal_request_fields(table);
    }
};

/// Whether reports are lost, late, wrong, or helped by other sensors, in any way: vehicles are not simply
/// known as they are.
bool reports_fail(const FailureConfig& config);

/// Everything wrong with a configuration: values out of range, values that contradict each other. `where`
/// names the place, for example `study.toml: failure`. Empty when all is well.
std::vector<core::Problem> problems_of(const FailureConfig& config, const std::string& where);

/// What a preset is about. One of each kind may be named.
enum class PresetKind : std::uint8_t {
    reports,        ///< A whole configuration.
    request_loss,   ///< Loss of requests to signals.
    request_range,  ///< Range of requests to signals.
};

/// A named, frozen configuration.
struct FailurePreset {
    std::string name;
    std::string summary;
    FailureConfig config;  ///< Of the preset alone.
    PresetKind kind = PresetKind::reports;
};

/// `perfect`, A.1 to A.7 (independent loss of 0.1 to 0.7 of the reports), B5, B10, B20 (outages of 5, 10, 20
/// s on average, dark 0.3 of the time), C.link, C.range (B10 where half of the dark links are still detected,
/// by presence or with a range of 1 m error), D1, D3, D5 (white position noise of 1, 3, 5 m), DL2 (2 s
/// latency), D3B10 (D3 and B10), B40 (outages of 40 s), D3M, D5M (D3 and D5 with heading errors and map
/// matching by the receiver), R50, R0 (routes of half of the vehicles and of none), S0 (no letters of
/// signals), mixed (B20, D3M and R50 together). Of requests to signals: Q10 to Q90 (10 to 90 % of the
/// messages lost, both ways; in reach of 10 km where no range is named), range_75m, range_150m, range_300m,
/// range_600m and range_10km (heard in line of sight, by half of the signals at this distance).
std::vector<FailurePreset> failure_presets();

/// The configuration that a text names: presets, fields of FailureConfig, or both, separated by commas:
/// `B10`, `B10,Q50,range_150m`, `B10,dark_share=0.5,exits=unknown`, `connected_share=0.3,onboard_range_m=80`.
/// A preset of reports comes first, those of requests follow in any order, then fields. Without a preset of
/// reports, it starts from reports at 1 Hz that never fail. Throws core::InputError with every problem:
/// unknown names (with the nearest known one), repeated fields, values that are not numbers, are out of range
/// or contradict each other.
FailureConfig failure_from(const std::string& text);

}  // namespace clearway::failures
