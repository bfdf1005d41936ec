#include "results/detail/signal_event_files.hpp"

#include <stdexcept>
#include <string_view>

#include <fmt/format.h>

#include "core/csv.hpp"
#include "core/error.hpp"

namespace clearway::results::detail {
namespace {

metrics::SignalEvent event_from(const std::vector<std::string_view>& cells) {
    metrics::SignalEvent event;
    std::size_t column = 0;
    core::for_each_field<metrics::SignalEvent>([&](const auto& field) {
        if (column == cells.size()) throw std::runtime_error("is too short");
        core::read_cell(cells[column++], event.*field.member);
    });
    if (cells.size() != column + 1)
        throw std::runtime_error(cells.size() <= column ? "is too short" : "is too long");
    if (metrics::name(static_cast<metrics::SignalCode>(event.event)) != cells[column])
        throw std::runtime_error(fmt::format("event {} is not \"{}\"", event.event, cells[column]));
    return event;
}

}  // namespace

std::string signal_event_header() {
    std::string line;
    core::append_header<metrics::SignalEvent>(line);
    return line.substr(1) + ",name";
}

std::string signal_event_cells(const metrics::SignalEvent& event) {
    std::string line;
    core::append_cells(line, event);
    return line.substr(1) + "," +
           core::csv_text(metrics::name(static_cast<metrics::SignalCode>(event.event)));
}

std::string signal_events_to_csv(const std::vector<metrics::SignalEvent>& events) {
    std::string text = signal_event_header() + "\n";
    for (const metrics::SignalEvent& event : events)
        text += signal_event_cells(event) + "\n";
    return text;
}

std::vector<metrics::SignalEvent> signal_events_from_csv(const std::string& text, const std::string& where) {
    const char* const cure =
        "Repeat the command that made the study (command.txt): it sets the run aside "
        "and makes it again";
    if (!text.starts_with(signal_event_header() + "\n"))
        throw core::InputError(
            {where + ":1", "is not the header of an event log", signal_event_header(), cure});
    std::vector<metrics::SignalEvent> events;
    std::size_t line = 1;
    try {
        core::CsvReader reader(text);
        reader.next();
        for (; reader.next(); ++line) {
            events.push_back(event_from(reader.cells()));
            if (events.size() > 1 && events.back().time_s < events[events.size() - 2].time_s)
                throw std::runtime_error(
                    fmt::format("time {} is before that of the line above", events.back().time_s));
        }
    } catch (const std::runtime_error& error) {
        throw core::InputError({fmt::format("{}:{}", where, line + 1), error.what(), "", cure});
    }
    return events;
}

}  // namespace clearway::results::detail
