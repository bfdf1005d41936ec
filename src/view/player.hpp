#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "view/run_view.hpp"

namespace clearway::view {

/// One trip, watched in one or two runs, side by side and in step.
struct Play {
    std::string title;
    std::string note;         ///< What is shown and what not, in a sentence; may be empty.
    std::size_t drawing = 0;  ///< Number in PlayList::drawings.
    std::vector<RunView> runs;
    std::string followed;  ///< SUMO's id of the emergency vehicle to follow; empty: the first.
};

/// What a page plays.
struct PlayList {
    std::vector<std::string> drawings;  ///< As `drawing_of` makes them.
    std::vector<Play> plays;
};

/// Markup for a page: a place for the player, its data and its script. To be used once in a page, whose
/// policy must allow `script_source()`. Every name is data and never markup. Data is compressed.
std::string player_markup(const PlayList& list);

/// The source that a Content-Security-Policy must allow for scripts: 'sha256-...'.
std::string script_source();

/// What the beginning of a page with a player holds, and no other page.
inline constexpr std::string_view page_mark = "<div class=\"clearway-player\" data-mode=\"replay\">";
/// A whole page with a player: one file that needs no server and loads nothing.
std::string player_page(const std::string& title, const PlayList& list);

/// The page of a server: it asks the server that sent it for a WebSocket at `/stream`.
std::string live_page(const std::string& title);

/// Zlib's format, then base64 (RFC 4648): how a page carries bytes.
std::string packed(std::string_view bytes);

}  // namespace clearway::view
