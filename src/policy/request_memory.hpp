#pragma once

#include <cstdint>

#include "core/fields.hpp"
#include "core/spellings.hpp"

namespace clearway::policy {

/// What a signal believes of an emergency vehicle between two of its messages.
enum class RequestMemory : std::uint8_t {
    forget,       ///< Nothing, once a message is overdue.
    hold_eta,     ///< That it comes at the time that it last announced.
    dead_reckon,  ///< That it drives on at its last speed, up to a red light or a standing queue.
    graph,        ///< What the believed graph knows better; otherwise as dead_reckon.
};
constexpr core::Spellings<RequestMemory, 4> spellings(RequestMemory) {
    return {{{RequestMemory::forget, "forget"},
             {RequestMemory::hold_eta, "hold_eta"},
             {RequestMemory::dead_reckon, "dead_reckon"},
             {RequestMemory::graph, "graph"}}};
}

/// How a signal remembers requests that reach it by message; base of a policy's configuration. Without effect
/// where the channel of requests to signals is perfect.
struct RequestMemorySettings {
    RequestMemory memory = RequestMemory::forget;
    double timeout_s = 2.0;
    double window_s = 10.0;
    double longest_memory_s = 30.0;

    static constexpr void fields(const auto& table) {
        using C = RequestMemorySettings;
        using core::Field;
        table(
            Field{
                "memory", "", &C::memory, 0, 0,
                "What a signal assumes about an emergency vehicle between its messages; without a predictor, "
                "graph knows vehicles whose newest report arrived and equals dead_reckon for others",
                "forget: assumes least about the controller"},
            Field{"timeout_s", "s", &C::timeout_s, 0.0, 60.0,
                  "forget: a request ends when nothing was heard for longer than this",
                  "assumed: three messages at the usual interval are missed"},
            Field{"window_s", "s", &C::window_s, 0.0, 60.0,
                  "The other memories: a request ends when the vehicle is believed to be overdue for longer "
                  "than this",
                  "assumed: a stop behind a vehicle that starts late"},
            Field{"longest_memory_s", "s", &C::longest_memory_s, 1.0, 300.0,
                  "A request ends when its newest message is older than this, whatever the memory",
                  "assumed: half of the longest hold"});
    }
};

}  // namespace clearway::policy
