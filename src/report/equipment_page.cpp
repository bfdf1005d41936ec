#include <algorithm>
#include <functional>
#include <map>
#include <set>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "core/labels.hpp"
#include "report/detail/axes.hpp"
#include "report/detail/equipment_order.hpp"
#include "report/detail/equipment_sheets.hpp"
#include "report/detail/figures.hpp"
#include "report/detail/map_canvas.hpp"
#include "report/detail/plain_page.hpp"
#include "report/equipment.hpp"
#include "report/text.hpp"

namespace clearway::report {
namespace {

constexpr std::size_t drawn_candidates = 30;  ///< Those with the greatest gains; the table has all.

enum class Disc : std::uint8_t { shown, not_shown, other };

/// A disc with a rank or the number of a signal: filled where the gain is shown, grey where it is not chosen.
std::string disc(const core::Spot& at, const std::string& words, Disc kind) {
    const char* const circle = kind == Disc::shown ? "dot better" : kind == Disc::other ? "spare" : "station";
    const double size = core::disc_text_size(words);
    return fmt::format(
        "<circle class=\"{}\" cx=\"{:.1f}\" cy=\"{:.1f}\" r=\"{:g}\"/><text class=\"{}\" x=\"{:.1f}\" "
        "y=\"{:.1f}\" text-anchor=\"middle\" style=\"font-size:{:g}px\">{}</text>\n",
        circle, at.x, at.y, core::disc_radius, kind == Disc::shown ? "onDot" : "rank", at.x,
        at.y + 0.35 * size, size, words);
}

/// What the disc of a chosen signal shows: its rank, or its number where there is no order.
std::string words_on_disc(const EquipmentFacts& facts, std::size_t rank) {
    return detail::has_order(facts) ? std::to_string(rank + 1)
                                    : fmt::format("#{}", facts.ranked[rank].number);
}

Disc kind_of(const EquippedSignal& signal) {
    return is_shown(signal.gain) ? Disc::shown : Disc::not_shown;
}

/// Whether the candidates that are not chosen have room for discs with their numbers.
bool has_room(const EquipmentFacts& facts) {
    return facts.candidates.size() <= drawn_candidates;
}

/// The disc of each signal that has one, by id.
std::map<std::string, std::pair<std::string, Disc>> discs_of(const EquipmentFacts& facts) {
    std::map<std::string, std::pair<std::string, Disc>> discs;
    for (std::size_t rank = 0; rank < facts.ranked.size(); ++rank)
        discs.emplace(facts.ranked[rank].signal,
                      std::pair(words_on_disc(facts, rank), kind_of(facts.ranked[rank])));
    if (has_room(facts))
        for (const EquipCandidateFacts& one : facts.candidates)
            discs.emplace(one.signal, std::pair(fmt::format("#{}", one.number), Disc::other));
    return discs;
}

void draw_signals(detail::MapCanvas& canvas, const EquipmentFacts& facts) {
    const auto discs = discs_of(facts);
    std::set<std::string> open;
    for (const EquipCandidateFacts& one : facts.candidates)
        open.insert(one.signal);
    const std::set<std::string> today(facts.equipped_today.begin(), facts.equipped_today.end());
    std::vector<core::Spot> places;
    std::vector<core::Mark> marks;
    for (const MapSignal& signal : facts.roads->signals) {
        const auto [x, y] = canvas.place(signal.place);
        places.push_back({x, y});
        marks.push_back(discs.contains(signal.id) ? core::Mark::disc : core::Mark::dot);
        const bool is_open = open.contains(signal.id);
        if (today.contains(signal.id))
            canvas.circle(x, y, core::dot_radius, "dot better");
        else if (marks.back() == core::Mark::dot)
            canvas.circle(x, y, is_open ? core::dot_radius : 2.0, is_open ? "held" : "tick");
    }
    const std::vector<core::Spot> spots = core::spread(places, marks, {canvas.width, canvas.height()});
    for (std::size_t row = 0; row < spots.size(); ++row) {
        if (marks[row] == core::Mark::dot) continue;
        if (spots[row] != places[row]) {
            canvas.path({{places[row].x, places[row].y}, {spots[row].x, spots[row].y}}, "zero");
            canvas.circle(places[row].x, places[row].y, 2.5, "dot s0");
        }
        const auto& [words, kind] = discs.at(facts.roads->signals[row].id);
        canvas.add(disc(spots[row], words, kind));
    }
}

/// The first chosen signal of this kind, as an example of its disc; nothing without one.
std::optional<detail::LegendEntry> chosen_entry(const EquipmentFacts& facts, Disc kind, const char* words) {
    const auto found = std::ranges::find(facts.ranked, kind, kind_of);
    if (found == facts.ranked.end()) return std::nullopt;
    const auto rank = static_cast<std::size_t>(found - facts.ranked.begin());
    const std::string example =
        detail::has_order(facts) ? fmt::format(" (rank {} is #{})", rank + 1, found->number) : "";
    return detail::LegendEntry{disc({20.0, 5.0}, words_on_disc(facts, rank), kind), words + example};
}

std::vector<detail::LegendEntry> map_entries(const EquipmentFacts& facts) {
    std::vector<detail::LegendEntry> entries;
    if (const auto entry = chosen_entry(facts, Disc::shown, "chosen, gain shown")) entries.push_back(*entry);
    if (const auto entry = chosen_entry(facts, Disc::not_shown, "chosen, gain not shown"))
        entries.push_back(*entry);
    const auto other = std::ranges::find_if_not(
        facts.candidates, [](const EquipCandidateFacts& one) { return one.rank.has_value(); });
    if (other != facts.candidates.end())
        entries.push_back(
            has_room(facts)
                ? detail::LegendEntry{disc({20.0, 5.0}, fmt::format("#{}", other->number), Disc::other),
                                      "other candidate"}
                : detail::dot_entry("held", "other candidate"));
    if (!facts.equipped_today.empty()) entries.push_back(detail::dot_entry("dot better", "equipped today"));
    if (facts.signals > facts.candidates.size() + facts.equipped_today.size())
        entries.push_back({"<circle class=\"tick\" cx=\"20\" cy=\"5\" r=\"2\"/>", "left out"});
    if (!facts.roads->stations.empty())
        entries.push_back({detail::station_sign, detail::station_words(*facts.roads)});
    return entries;
}

/// `Discs show ranks: 1 is #7, 2 is #12.`; where there are none, the answer that says so.
std::string order_words(const EquipmentFacts& facts) {
    constexpr std::size_t most_named = 12;
    if (!detail::has_order(facts))
        return detail::findings_of(facts).front() + " Numbers are those of the tables.";
    std::vector<std::string> words;
    for (const EquippedSignal& signal : facts.ranked)
        words.push_back(fmt::format("{} is #{}", words.size() + 1, signal.number));
    if (words.size() > most_named) words.resize(most_named);
    if (words.empty()) return "";
    return fmt::format("Discs show ranks: {}{}.", fmt::join(words, ", "),
                       words.size() < facts.ranked.size() ? " and so on, as in the table" : "");
}

std::string paragraphs(const std::vector<std::string>& sentences, const char* style) {
    return fmt::format("<p class=\"{}\">{}</p>\n", style,
                       escaped(fmt::format("{}", fmt::join(sentences, " "))));
}

std::string list_of(const std::vector<std::string>& sentences) {
    std::string html = "<ul>\n";
    for (const std::string& sentence : sentences)
        html += fmt::format("<li>{}</li>\n", escaped(sentence));
    return html + "</ul>\n";
}

std::string command_html(const std::string& words, const std::string& command) {
    if (command.empty()) return "";
    return fmt::format("<p>{}</p>\n<pre><code>{}</code></pre>\n", words, escaped(command));
}

/// The words of the page, for who is no statistician.
std::string words_html(const EquipmentFacts& facts) {
    return paragraphs(
        {fmt::format("Seed {} decides: its runs choose the signals. Seed {} estimates: fresh runs that had "
                     "no part in the choice tell the gains, so that luck in choosing is not counted.",
                     facts.seed, facts.fresh_seed),
         "Restricted mean travel time: mean time from departure to arrival; an EV that does not arrive "
         "counts as if it had at the end of the simulated time.",
         "Alone: of a signal, equipped as the only one; of EV time, on empty roads."},
        "note");
}

std::string note(const std::string& words) {
    return paragraphs({words}, "note");
}

std::string figures(const std::vector<detail::Figure>& all) {
    std::string html;
    for (const detail::Figure& figure : all)
        if (!figure.drawing.empty()) html += detail::to_html(figure);
    if (html.empty()) return "";
    return fmt::format("<div class=\"figures {}\">\n{}</div>\n", all.size() == 1 ? "one" : "pair", html);
}

/// With what is said of it on the page, as it may be handed on alone.
std::string standalone_or_empty(const EquipmentFacts& facts, const detail::Figure& figure) {
    if (figure.drawing.empty()) return "";
    return detail::standalone(figure.drawing, fmt::format("{}: which signals to equip first", facts.title),
                              figure.note);
}

}  // namespace

namespace detail {

Figure curve_figure(const EquipmentFacts& facts) {
    const Range numbers(0.0, static_cast<double>(std::max<std::size_t>(facts.ranked.size(), 1)));
    Range gains(0.0, 0.0);
    bool has_intervals = false;
    if (facts.all_gain) gains.include(facts.all_gain->mean);
    for (const EquippedSignal& signal : facts.ranked) {
        if (signal.so_far) gains.include(signal.so_far->mean);
        if (shown_interval(signal.so_far) == nullptr) continue;
        gains.include_all(signal.so_far);
        has_intervals = true;
    }
    Chart plot(fmt::format("{}: gain against number of signals equipped", facts.title), 260.0,
               {padded(numbers, 0.05), "signals equipped, number", 0.0, 0.0, Scale::whole},
               {padded(gains, 0.1), labelled(primary, "gain")});
    plot.horizontal(0.0);
    Points points = {{0.0, 0.0}};
    for (std::size_t rank = 0; rank < facts.ranked.size(); ++rank) {
        const MaybeEstimate& gain = facts.ranked[rank].so_far;
        if (!gain) continue;
        const auto equipped = static_cast<double>(rank + 1);
        points.emplace_back(equipped, gain->mean);
        if (shown_interval(gain) != nullptr)
            plot.whisker(equipped, {gain->interval->low, gain->interval->high}, {0});
    }
    // Without marks, which would stand beside the whole numbers.
    plot.line(points, {0, Series::Weight::lead});
    const bool has_order = detail::has_order(facts);
    std::vector<LegendEntry> legend = {line_entry(
        {0, Series::Weight::lead}, fmt::format("{}{}", has_order ? "the first signals" : "the chosen signals",
                                               has_intervals ? ", with intervals of 95 % each" : ""))};
    if (facts.all_gain) {
        plot.line({{numbers.low, facts.all_gain->mean}, {numbers.high, facts.all_gain->mean}}, {2});
        legend.push_back(line_entry({2}, fmt::format("all of {}", counted(facts.signals, "signal"))));
    }
    plot.legend(legend);
    return {"curve",
            "Gain by number of signals",
            plot.finish(),
            has_order ? "" : detail::findings_of(facts).front(),
            {}};
}

Figure candidates_figure(const EquipmentFacts& facts) {
    constexpr std::size_t short_name = 36;    // stands beside its interval, a longer one above
    constexpr std::size_t longest_name = 68;  // the table has the rest
    std::vector<EquipCandidateFacts> drawn;
    for (const EquipCandidateFacts& one : facts.candidates)
        if (one.gain) drawn.push_back(one);
    if (drawn.empty()) return {};
    std::ranges::stable_sort(drawn, std::greater{},
                             [](const EquipCandidateFacts& one) { return one.gain->mean; });
    drawn.resize(std::min(drawn.size(), drawn_candidates));
    Range gains(0.0, 0.0);
    for (const EquipCandidateFacts& one : drawn)
        gains.include(one.gain);
    const auto name_of = [](const EquipCandidateFacts& one) {
        return printable(one.streets.empty() ? one.signal : one.streets);
    };
    const bool are_short = std::ranges::all_of(
        drawn, [&](const EquipCandidateFacts& one) { return name_of(one).size() <= short_name; });
    const double row_height = are_short ? 18.0 : 32.0;
    const double names_end = are_short ? 226.0 : 0.0;
    const double bottom = top_edge + row_height * static_cast<double>(drawn.size());
    Plot plot(fmt::format("{}: gain of each candidate alone", facts.title), bottom + label_space,
              {padded(gains, 0.05), labelled(primary, "gain"), names_end + 8.0, right_edge},
              {{0.0, 1.0}, "", bottom, top_edge});
    plot.grid_x();
    plot.vertical(0.0);
    double y = top_edge + 0.5 * row_height;
    for (const EquipCandidateFacts& one : drawn) {
        const std::string name = fmt::format("#{} {}", one.number, shortened(name_of(one), longest_name));
        if (are_short)
            plot.text(names_end, y + 4.0, name, Canvas::Anchor::end, "tick");
        else
            plot.text(plot.x().from, y - 4.0, name, Canvas::Anchor::start, "tick");
        plot.estimate(one.gain, shown_interval(one.gain), are_short ? y : y + 8.0,
                      {is_shown(one.gain) ? std::size_t{1} : std::size_t{2}});
        y += row_height;
    }
    return {"candidates",
            "Gain of each candidate alone",
            plot.finish(),
            drawn.size() < facts.candidates.size()
                ? fmt::format("The first {} of {}.", drawn.size(), facts.candidates.size())
                : "",
            {}};
}

Figure equipment_map_figure(const EquipmentFacts& facts) {
    if (!facts.roads || !is_drawable(*facts.roads)) return {};
    MapCanvas canvas =
        MapCanvas::of_signals(fmt::format("{}: which signals to equip first", facts.title), *facts.roads);
    canvas.edges(all_edges(*facts.roads), "road");
    canvas.scale_bar();
    canvas.stations(*facts.roads);
    draw_signals(canvas, facts);
    canvas.credit(facts.attribution);
    canvas.legend(map_entries(facts));
    return {"map", "Where they are", canvas.finish(), order_words(facts), {}};
}

}  // namespace detail

std::string equipment_curve(const EquipmentFacts& facts) {
    return standalone_or_empty(facts, detail::curve_figure(facts));
}

std::string equipment_map(const EquipmentFacts& facts) {
    return standalone_or_empty(facts, detail::equipment_map_figure(facts));
}

void write_equipment_page(const EquipmentFacts& facts, std::ostream& page) {
    using detail::to_html;
    const std::vector<std::string> findings = detail::findings_of(facts);
    const std::string answer =
        paragraphs({findings.front()}, "headline") +
        (facts.other_parts.empty() ? "" : note(detail::signals_alone_sentence(facts))) + note(facts.outlook) +
        note(facts.assumptions) + detail::coarse_step_note(facts.step_length_s) +
        list_of({findings.begin() + 1, findings.end()}) +
        command_html(detail::more_seeds_words, detail::more_seeds_command(facts)) +
        command_html(detail::study_words(facts), detail::study_command(facts)) +
        figures({detail::equipment_map_figure(facts), detail::curve_figure(facts)}) +
        (facts.ranked.empty() ? ""
                              : to_html(detail::data_table_of(detail::ranks_table(facts))) +
                                    note(detail::ranks_legend(facts))) +
        to_html(detail::data_table_of(detail::curve_table(facts))) + note(detail::curve_legend(facts)) +
        (facts.events.empty() ? ""
                              : to_html(detail::data_table_of(detail::event_sheet(facts))) +
                                    note(detail::event_legend(facts)));
    std::vector<detail::PageSection> sections;
    if (!facts.ranked.empty())
        sections.push_back({"council", "For the council", list_of(detail::council_lines(facts))});
    sections.push_back({"equipment", "Which first", answer});
    const std::string pairs =
        facts.pairs.empty()
            ? ""
            : to_html(detail::data_table_of(detail::pair_sheet(facts))) + note(detail::pair_legend());
    if (!facts.candidates.empty())
        sections.push_back({"candidates", "All candidates",
                            figures({detail::candidates_figure(facts)}) +
                                to_html(detail::data_table_of(detail::candidate_sheet(facts))) +
                                note(detail::candidate_legend(facts)) + pairs});
    sections.push_back({"reproduce", "Conditions",
                        words_html(facts) + paragraphs(detail::circumstances_of(facts), "") + "<pre><code>" +
                            escaped(facts.command) + "</code></pre>\n"});
    detail::write({facts.title + ": which signals to equip first",
                   fmt::format("{}, {}; seed {} decides, seed {} estimates. {}", facts.condition,
                               counted(facts.replications, "replication"), facts.seed, facts.fresh_seed,
                               facts.met.words()),
                   sections, "Means of replications with 95 % intervals. EV: emergency vehicle."},
                  page);
}

}  // namespace clearway::report
