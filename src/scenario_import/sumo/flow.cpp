#include "scenario_import/sumo/flow.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include <fmt/format.h>

#include "core/error.hpp"
#include "scenario_import/sumo/draw.hpp"

namespace clearway::scenario_import::detail {

namespace {

constexpr double day_s = 86400.0;

/// Most departures of one flow: a vehicle every 20 ms of a day.
constexpr std::size_t most_departures = 4'320'000;

bool has_rate(const Element& flow) {
    constexpr std::array rates = {"period",         "perHour",           "vehsPerHour",
                                  "personsPerHour", "containersPerHour", "probability"};
    return std::ranges::any_of(rates, [&](const char* const name) { return flow.has(name); });
}

/// The departures of one flow, by the kind of its rate.
class Flow {
  public:
    Flow(const Element& flow, const FlowTimes& times, double scale)
        : id_(flow.text("id")),
          from_s_(times.from_s),
          wanted_until_s_(times.until_s),
          scale_(scale),
          count_(number(flow.text("number"))) {
        begin_s_ = time_s(flow.text("begin")).value_or(times.begin_s);
        end_s_ = time_s(flow.text("end")).value_or(times.end_s.value_or(begin_s_ + day_s));
        // SUMO counts by a rate to the number, whatever the end of the configuration.
        if (count_ && !flow.has("end") && has_rate(flow)) end_s_ = begin_s_ + day_s;
        until_s_ = std::min({end_s_, times.until_s, std::max(begin_s_, from_s_) + day_s});
        if (count_) *count_ = static_cast<double>(copies(id_, *count_ * scale_));
    }

    std::optional<std::vector<Departure>> departures(const Element& flow) {
        const std::string& period = flow.text("period");
        std::string hourly = flow.text("perHour");
        for (const char* const name : {"vehsPerHour", "personsPerHour"})
            if (flow.has(name)) hourly = flow.text(name);
        if (period.starts_with("exp("))
            by_exponential(number(period.substr(4, period.find(')') - 4)).value_or(0.0));
        else if (time_s(period).value_or(0.0) > 0.0)
            regular(*time_s(period) / scale_);
        else if (number(hourly).value_or(0.0) > 0.0)
            regular(3600.0 / *number(hourly) / scale_);
        else if (flow.has("probability"))
            by_chance(number(flow.text("probability")).value_or(0.0));
        else if (count_ && end_s_ == begin_s_)
            at_once();
        else if (count_ && *count_ > 0.0)
            regular((end_s_ - begin_s_) / *count_);
        else if (!number(hourly) && !count_)
            return std::nullopt;
        return std::move(found_);
    }

  private:
    void add(std::size_t row, double at_s, double later_s = 0.0) {
        if (++tried_ > most_departures)
            throw core::InputError(
                {fmt::format("flow \"{}\"", id_), fmt::format("has more than {} departures", most_departures),
                 fmt::format("at most {}", most_departures), "correct its rate or number"});
        if (at_s >= from_s_) found_.push_back({row, at_s, later_s});
    }
    double most() const { return count_.value_or(std::numeric_limits<double>::infinity()); }

    void regular(double period_s) {
        if (!(period_s > 0.0)) return;
        const double first = std::max(0.0, std::floor((from_s_ - begin_s_) / period_s));
        for (double row = first; row < most() && begin_s_ + row * period_s < until_s_; ++row)
            add(static_cast<std::size_t>(row), begin_s_ + row * period_s, row * period_s);
    }

    void at_once() {
        for (std::size_t row = 0; static_cast<double>(row) < *count_ && begin_s_ < wanted_until_s_; ++row)
            add(row, begin_s_);
    }

    void by_exponential(double rate) {
        std::size_t row = 0;
        double at_s = begin_s_;
        for (std::uint64_t draw = 0; rate > 0.0 && static_cast<double>(row) < most(); ++row) {
            at_s -= std::log1p(-uniform(id_, draw++)) / (rate * scale_);
            if (at_s >= until_s_) break;
            add(row, std::round(at_s * 100.0) / 100.0);
        }
    }

    void by_chance(double chance) {
        std::size_t row = 0;
        const double whole = std::floor(chance * scale_);
        for (std::uint64_t second = 0; begin_s_ + static_cast<double>(second) < until_s_; ++second) {
            const double at_s = begin_s_ + static_cast<double>(second);
            double now = whole + (uniform(id_, second) < chance * scale_ - whole ? 1.0 : 0.0);
            for (; now > 0.0 && static_cast<double>(row) < most(); --now)
                add(row++, at_s);
        }
    }

    const std::string& id_;
    double from_s_;
    double wanted_until_s_;
    double scale_;
    std::optional<double> count_;
    double begin_s_ = 0.0;
    double end_s_ = 0.0;
    double until_s_ = 0.0;
    std::size_t tried_ = 0;
    std::vector<Departure> found_;
};

}  // namespace

std::optional<std::string> fault_of_flow(const Element& flow, const FlowTimes& times) {
    const std::string& begin = flow.text("begin");
    const std::string& end = flow.text("end");
    for (const std::string* const time : {&begin, &end})
        if (!time->empty() && !time_s(*time)) return fmt::format("has the time \"{}\"", *time);
    const double begin_s = time_s(begin).value_or(times.begin_s);
    if (begin_s < 0.0 || begin_s > latest_departure_s) return fmt::format("begins at {} s", begin_s);
    const auto end_s = end.empty() ? times.end_s : time_s(end);
    if (end_s && *end_s < begin_s && (!end.empty() || flow.has("number")))
        return fmt::format("ends at {} s, before its begin at {} s", *end_s, begin_s);
    const auto count = number(flow.text("number"));
    if (flow.has("number") && (!count || *count < 0.0 || *count != std::floor(*count)))
        return fmt::format("has the number \"{}\"", flow.text("number"));
    const auto chance = number(flow.text("probability"));
    if (flow.has("probability") && (!chance || *chance <= 0.0 || *chance > 1.0))
        return fmt::format("has the probability \"{}\"", flow.text("probability"));
    return std::nullopt;
}

std::optional<std::vector<Departure>> departures(const Element& flow, const FlowTimes& times, double scale) {
    if (scale <= 0.0) return std::vector<Departure>{};
    return Flow(flow, times, scale).departures(flow);
}

}  // namespace clearway::scenario_import::detail
