#include "actuation/detail/link_history.hpp"

#include "traffic/signal.hpp"

namespace clearway::actuation::detail {
namespace {

constexpr core::Seconds long_ago{-1e9};

}  // namespace

void LinkHistory::watch(const std::string& state, core::Seconds now) {
    for (std::size_t row = links_.size(); row < state.size(); ++row)
        links_.push_back({state[row], long_ago, long_ago, long_ago});
    for (std::size_t row = 0; row < state.size(); ++row) {
        Link& link = links_[row];
        const char letter = state[row];
        if (traffic::is_green(letter) && !traffic::is_green(link.letter)) link.green_since = now;
        if (traffic::is_yellow(letter) && !traffic::is_yellow(link.letter)) link.yellow_since = now;
        if (traffic::is_red(letter) && !traffic::is_red(link.letter)) link.red_since = now;
        link.letter = letter;
    }
}

double LinkHistory::green_s(std::uint16_t link, core::Seconds now) const {
    if (link >= links_.size() || !traffic::is_green(links_[link].letter)) return 0.0;
    return (now - links_[link].green_since).value;
}

double LinkHistory::yellow_s(std::uint16_t link, core::Seconds now) const {
    if (link >= links_.size() || !traffic::is_yellow(links_[link].letter)) return 0.0;
    return (now - links_[link].yellow_since).value;
}

double LinkHistory::red_s(std::uint16_t link, core::Seconds now) const {
    if (link >= links_.size() || !traffic::is_red(links_[link].letter)) return 0.0;
    return (now - links_[link].red_since).value;
}

}  // namespace clearway::actuation::detail
