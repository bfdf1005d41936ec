#include "view/player.hpp"

#include <algorithm>
#include <stdexcept>

#include <fmt/format.h>
#include <zlib.h>

#include "core/json.hpp"
#include "core/markup.hpp"
#include "view/detail/page_script.hpp"
#include "view/frame_encoder.hpp"

namespace clearway::view {
namespace {

std::string base64(std::string_view bytes) {
    static constexpr std::string_view digits =
        "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    std::string text;
    text.reserve((bytes.size() + 2) / 3 * 4);
    for (std::size_t at = 0; at < bytes.size(); at += 3) {
        std::uint32_t group = 0;
        const std::size_t count = std::min<std::size_t>(3, bytes.size() - at);
        for (std::size_t i = 0; i < 3; ++i)
            group = group << 8U | (i < count ? static_cast<unsigned char>(bytes[at + i]) : 0U);
        for (std::size_t i = 0; i < 4; ++i)
            text.push_back(i <= count ? digits[group >> (18 - 6 * i) & 63U] : '=');
    }
    return text;
}

/// JSON that may stand in a script element: no `<`, so neither its end nor a comment.
std::string as_data(const core::Json& json) {
    std::string text;
    for (const char letter : json.dump(-1, ' ', false, core::Json::error_handler_t::replace)) {
        if (letter == '<') {
            text += "\\u003c";
        } else {
            text.push_back(letter);
        }
    }
    return text;
}

core::Json json_of(const Play& play) {
    core::Json runs = core::Json::array();
    for (const RunView& run : play.runs)
        runs.push_back({{"about", core::Json::parse(run.about)},
                        {"begin_s", run.begin_s},
                        {"end_s", run.end_s},
                        {"stream", packed(run.stream)}});
    return {{"title", play.title},
            {"note", play.note},
            {"drawing", play.drawing},
            {"followed", play.followed},
            {"runs", std::move(runs)}};
}

std::string script_element() {
    std::string element = "<script>";
    element.append(detail::page_script()).append("</script>\n");
    return element;
}

std::string page(const std::string& title, const std::string& connect, const std::string& body) {
    return fmt::format(
               "<!DOCTYPE html>\n"
               "<html lang=\"en\">\n"
               "<head>\n"
               "<meta charset=\"utf-8\">\n"
               "<meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n"
               "<meta http-equiv=\"Content-Security-Policy\" content=\"default-src 'none'; "
               "script-src {}; style-src 'unsafe-inline'; img-src data: blob:{}\">\n"
               "<link rel=\"icon\" href=\"data:,\">\n"
               "<title>{}</title>\n</head>\n<body>\n<h1>{}</h1>\n",
               script_source(), connect, core::escaped(title), core::escaped(title)) +
           body + "</body>\n</html>\n";
}

std::string player_element(const char* mode) {
    return fmt::format(
        "<div class=\"clearway-player\" data-mode=\"{}\"><noscript>This part of the page needs "
        "JavaScript.</noscript></div>\n",
        mode);
}

}  // namespace

std::string packed(std::string_view bytes) {
    uLongf size = compressBound(bytes.size());
    std::string compressed(size, '\0');
    const int result = compress2(reinterpret_cast<Bytef*>(compressed.data()), &size,
                                 reinterpret_cast<const Bytef*>(bytes.data()), bytes.size(), 9);
    if (result != Z_OK) throw std::runtime_error(fmt::format("zlib: error {}", result));
    compressed.resize(size);
    return base64(compressed);
}

std::string player_markup(const PlayList& list) {
    core::Json data = {
        {"format", stream_format}, {"drawings", core::Json::array()}, {"plays", core::Json::array()}};
    for (const std::string& drawing : list.drawings)
        data["drawings"].push_back(packed(drawing));
    for (const Play& play : list.plays)
        data["plays"].push_back(json_of(play));
    return player_element("replay") + "<script type=\"application/json\" class=\"clearway-plays\">" +
           as_data(data) + "</script>\n" + script_element();
}

std::string script_source() {
    return fmt::format("'sha256-{}'", base64(detail::page_script_sha256()));
}

std::string player_page(const std::string& title, const PlayList& list) {
    return page(title, "", player_markup(list));
}

std::string live_page(const std::string& title) {
    return page(title, "; connect-src 'self'", player_element("live") + script_element());
}

}  // namespace clearway::view
