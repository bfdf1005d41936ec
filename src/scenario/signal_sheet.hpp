#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "roads/network.hpp"
#include "traffic/preemption.hpp"

namespace clearway::scenario {

/// The shortest and the longest of some times.
struct SecondsRange {
    double shortest_s = 0.0;
    double longest_s = 0.0;
};

/// An edge that leads to a signal.
struct SignalApproach {
    std::string edge;
    std::string street;                ///< Or empty. Text from a file.
    std::vector<std::uint16_t> links;  ///< Ascending.
};

/// A phase of the program.
struct SignalPhase {
    std::uint32_t number = 0;  ///< From 0, as SUMO counts.
    std::string name;          ///< Or empty. Text from a file.
    std::string state;
    double duration_s = 0.0;
    double least_s = 0.0;            ///< 0 where the program gives none.
    bool green = false;              ///< Some link is green and none is yellow.
    bool on_foot = false;            ///< A crossing for people on foot is green.
    std::vector<std::string> edges;  ///< Approaches that have green in it.
};

/// One signal of a scenario as a city would list it.
struct SignalSheet {
    std::string signal;
    std::string controller;
    std::string program;
    roads::Point place;        ///< Middle of its stop lines.
    bool coordinated = false;  ///< Fixed times: it keeps step with its neighbours.
    double cycle_s = 0.0;
    double offset_s = 0.0;
    std::uint32_t crossings = 0;                ///< For people on foot.
    std::optional<SecondsRange> yellow;         ///< That the program shows; none where it shows none.
    std::optional<SecondsRange> red_clearance;  ///< Likewise.
    std::optional<SecondsRange> least_green;    ///< Likewise.
    std::vector<SignalApproach> approaches;
    std::vector<SignalPhase> phases;
    traffic::Preemption set;  ///< In the scenario's file.
};

/// `Via Po / Via Roma`: the streets that lead to it, each once; empty where none has a name. Text from a
/// file.
std::string streets_of(const SignalSheet& sheet);

/// All signals of a network, by core::SignalIndex. `preemption` is as long, or empty.
std::vector<SignalSheet> signal_sheets(const roads::Network& network,
                                       const std::vector<traffic::Preemption>& preemption);

}  // namespace clearway::scenario
