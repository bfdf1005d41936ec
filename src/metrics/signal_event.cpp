#include "metrics/signal_event.hpp"

namespace clearway::metrics {

std::string_view name(SignalCode code) {
    switch (code) {
        case SignalCode::begin_green:
            return "Phase Begin Green";
        case SignalCode::begin_yellow:
            return "Phase Begin Yellow Clearance";
        case SignalCode::begin_red_clearance:
            return "Phase Begin Red Clearance";
        case SignalCode::end_red_clearance:
            return "Phase End Red Clearance";
        case SignalCode::begin_walk:
            return "Pedestrian Begin Walk";
        case SignalCode::begin_dont_walk:
            return "Pedestrian Begin Solid Don't Walk";
        case SignalCode::detector_on:
            return "Detector On";
        case SignalCode::call_on:
            return "Preempt (Call) Input On";
        case SignalCode::call_off:
            return "Preempt (Call) Input Off";
        case SignalCode::entry_started:
            return "Preempt Entry Started";
        case SignalCode::begin_dwell:
            return "Preemption Begin Dwell Service";
        case SignalCode::max_presence_exceeded:
            return "Preemption Max Presence Exceeded";
        case SignalCode::begin_exit:
            return "Preemption Begin Exit Interval";
        case SignalCode::coordination:
            return "Coord Cycle State Change";
    }
    return "";
}

}  // namespace clearway::metrics
