#include <algorithm>
#include <functional>
#include <map>
#include <set>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "core/labels.hpp"
#include "report/detail/axes.hpp"
#include "report/detail/equipment_sheets.hpp"
#include "report/detail/figures.hpp"
#include "report/detail/map_canvas.hpp"
#include "report/detail/plain_page.hpp"
#include "report/equipment.hpp"
#include "report/text.hpp"

namespace clearway::report {
namespace {

constexpr std::size_t drawn_candidates = 30;  ///< Those with the greatest gains; the table has all.

/// A disc with the rank: filled where the gain is shown.
std::string disc(const core::Spot& at, const std::string& rank, bool shown) {
    return fmt::format(
        "<circle class=\"{}\" cx=\"{:.1f}\" cy=\"{:.1f}\" r=\"{:g}\"/><text class=\"{}\" x=\"{:.1f}\" "
        "y=\"{:.1f}\" text-anchor=\"middle\">{}</text>\n",
        shown ? "dot better" : "station", at.x, at.y, core::disc_radius, shown ? "onDot" : "rank", at.x,
        at.y + 4.0, rank);
}

void draw_ranks(detail::MapCanvas& canvas, const EquipmentFacts& facts) {
    std::map<std::string, std::size_t> ranks;
    for (const EquippedSignal& signal : facts.ranked)
        ranks.emplace(signal.signal, ranks.size());
    std::map<std::string, std::size_t> numbers;  // of candidates
    for (const EquipCandidateFacts& one : facts.candidates)
        numbers.emplace(one.signal, one.number);
    const bool has_room = numbers.size() <= drawn_candidates;
    const bool has_order = detail::has_order(facts);
    const std::set<std::string> today(facts.equipped_today.begin(), facts.equipped_today.end());
    std::vector<core::Spot> places;
    std::vector<core::Mark> marks;
    for (const MapSignal& signal : facts.roads->signals) {
        const auto [x, y] = canvas.place(signal.place);
        places.push_back({x, y});
        marks.push_back(ranks.contains(signal.id) ? core::Mark::disc : core::Mark::dot);
        const bool is_open = numbers.contains(signal.id);
        if (today.contains(signal.id))
            canvas.circle(x, y, core::dot_radius, "dot better");
        else if (marks.back() == core::Mark::dot)
            canvas.circle(x, y, is_open ? core::dot_radius : 2.0, is_open ? "held" : "tick");
        if (marks.back() == core::Mark::dot && numbers.contains(signal.id) && has_room)
            canvas.text(x + 6.0, y - 4.0, std::to_string(numbers.at(signal.id)),
                        detail::Canvas::Anchor::start, "tick");
    }
    const std::vector<core::Spot> spots = core::spread(places, marks, {canvas.width, canvas.height()});
    for (std::size_t row = 0; row < spots.size(); ++row) {
        if (marks[row] == core::Mark::dot) continue;
        const std::size_t rank = ranks.at(facts.roads->signals[row].id);
        if (spots[row] != places[row])
            canvas.path({{places[row].x, places[row].y}, {spots[row].x, spots[row].y}}, "zero");
        const std::size_t shown = has_order ? rank + 1 : facts.ranked[rank].number;
        canvas.add(disc(spots[row], std::to_string(shown), is_shown(facts.ranked[rank].gain)));
    }
}

std::vector<detail::LegendEntry> map_entries(const EquipmentFacts& facts) {
    const auto shown = std::ranges::count_if(
        facts.ranked, [](const EquippedSignal& signal) { return is_shown(signal.gain); });
    const std::size_t chosen = facts.ranked.size();
    std::vector<detail::LegendEntry> entries;
    if (shown > 0) entries.push_back({disc({20.0, 5.0}, "n", true), "chosen, gain shown"});
    if (static_cast<std::size_t>(shown) < chosen)
        entries.push_back({disc({20.0, 5.0}, "n", false), "chosen, gain not shown"});
    if (facts.candidates.size() > chosen) entries.push_back(detail::dot_entry("held", "other candidate"));
    if (!facts.equipped_today.empty()) entries.push_back(detail::dot_entry("dot better", "equipped today"));
    if (facts.signals > facts.candidates.size() + facts.equipped_today.size())
        entries.push_back({"<circle class=\"tick\" cx=\"20\" cy=\"5\" r=\"2\"/>", "left out"});
    if (!facts.roads->stations.empty()) entries.push_back({detail::station_sign, "station"});
    return entries;
}

/// `Discs bear the order: 1 is #7, 2 is #12.`
std::string order_words(const EquipmentFacts& facts) {
    constexpr std::size_t most_named = 12;
    if (!detail::has_order(facts)) return "Numbers are those of the tables, in no order.";
    std::vector<std::string> words;
    for (const EquippedSignal& signal : facts.ranked)
        words.push_back(fmt::format("{} is #{}", words.size() + 1, signal.number));
    if (words.size() > most_named) words.resize(most_named);
    if (words.empty()) return "";
    return fmt::format("Discs bear the order: {}{}.", fmt::join(words, ", "),
                       words.size() < facts.ranked.size() ? " and so on, as in the table" : "");
}

std::string paragraphs(const std::vector<std::string>& sentences, const char* style) {
    return fmt::format("<p class=\"{}\">{}</p>\n", style,
                       escaped(fmt::format("{}", fmt::join(sentences, " "))));
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

std::string standalone_or_empty(const detail::Figure& figure) {
    return figure.drawing.empty() ? "" : detail::standalone(figure.drawing);
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
    std::vector<LegendEntry> legend = {
        line_entry({0, Series::Weight::lead},
                   has_intervals ? "the first signals, with 95 % intervals" : "the first signals")};
    if (facts.all_gain) {
        plot.line({{numbers.low, facts.all_gain->mean}, {numbers.high, facts.all_gain->mean}}, {2});
        legend.push_back(line_entry({2}, fmt::format("all of {}", counted(facts.signals, "signal"))));
    }
    plot.legend(legend);
    return {"curve", "Gain by number of signals", plot.finish(), "", {}};
}

Figure candidates_figure(const EquipmentFacts& facts) {
    constexpr double row_height = 18.0;
    constexpr double names_end = 226.0;
    constexpr std::size_t longest_name = 34;  // before it
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
    const double bottom = top_edge + row_height * static_cast<double>(drawn.size());
    Plot plot(fmt::format("{}: gain of each candidate alone", facts.title), bottom + label_space,
              {padded(gains, 0.05), labelled(primary, "gain"), names_end + 8.0, right_edge},
              {{0.0, 1.0}, "", bottom, top_edge});
    plot.grid_x();
    plot.vertical(0.0);
    double y = top_edge + 0.5 * row_height;
    for (const EquipCandidateFacts& one : drawn) {
        const std::string name =
            shortened(printable(one.streets.empty() ? one.signal : one.streets), longest_name);
        plot.text(names_end, y + 4.0, fmt::format("{} {}", one.number, name), Canvas::Anchor::end, "tick");
        plot.estimate(one.gain, shown_interval(one.gain), y,
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
    MapCanvas canvas(fmt::format("{}: signals to equip first", facts.title), *facts.roads);
    canvas.edges(all_edges(*facts.roads), "road");
    canvas.scale_bar();
    canvas.stations(*facts.roads);
    draw_ranks(canvas, facts);
    canvas.credit(facts.attribution);
    canvas.legend(map_entries(facts));
    return {"map", "Where they are", canvas.finish(), order_words(facts), {}};
}

}  // namespace detail

std::string equipment_curve(const EquipmentFacts& facts) {
    return standalone_or_empty(detail::curve_figure(facts));
}

std::string equipment_map(const EquipmentFacts& facts) {
    return standalone_or_empty(detail::equipment_map_figure(facts));
}

void write_equipment_page(const EquipmentFacts& facts, std::ostream& page) {
    using detail::to_html;
    const std::vector<std::string> findings = detail::findings_of(facts);
    const std::string answer =
        paragraphs({findings.front()}, "headline") + note(facts.assumptions) +
        detail::coarse_step_note(facts.step_length_s) +
        paragraphs({findings.begin() + 1, findings.end()}, "") +
        figures({detail::equipment_map_figure(facts), detail::curve_figure(facts)}) +
        to_html(detail::data_table_of(detail::ranked_sheet(facts, detail::LastRow::all))) +
        note(detail::ranked_legend(facts));
    std::vector<detail::PageSection> sections = {{"equipment", "Which first", answer}};
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
                        paragraphs(detail::circumstances_of(facts), "") + "<pre><code>" +
                            escaped(facts.command) + "</code></pre>\n"});
    detail::write({facts.title + ": signals to equip first",
                   fmt::format("{}, {}; seed {} decides, seed {} estimates. {}", facts.condition,
                               counted(facts.replications, "replication"), facts.seed, facts.fresh_seed,
                               facts.met.words()),
                   sections, "Means of replications with 95 % intervals. EV: emergency vehicle."},
                  page);
}

}  // namespace clearway::report
