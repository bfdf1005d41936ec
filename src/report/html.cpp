#include "report/html.hpp"

#include <fmt/format.h>

#include "report/detail/script.hpp"
#include "report/detail/style.hpp"
#include "report/sections/sections.hpp"
#include "report/text.hpp"

namespace clearway::report {
namespace {

using detail::Section;

void write_head(const std::string& title, const Replays& replays, std::ostream& page) {
    page << "<!DOCTYPE html>\n"
            "<html lang=\"en\">\n"
            "<head>\n"
            "<meta charset=\"utf-8\">\n"
            "<meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n"
            "<meta http-equiv=\"Content-Security-Policy\" content=\"default-src 'none'; style-src "
            "'unsafe-inline'; img-src data:; script-src '"
         << detail::policy_source(detail::script_sha256) << "'"
         << (replays.markup.empty() ? "" : " " + replays.script_source)
         << "\">\n"
            "<link rel=\"icon\" href=\"data:,\">\n"
            "<title>"
         << title << "</title>\n<style>" << detail::page_style() << "</style>\n</head>\n<body>\n";
}

void write_section(const Section& section, const StudyFacts& study, std::ostream& page,
                   detail::Writer& writer) {
    const bool folded = section.shown == Section::Shown::folded;
    const std::string title = fmt::format("<h2>{}</h2>", section.title);
    // The section is inside the fold, so that a link to it unfolds it.
    if (folded) page << "<details class=\"fold section\"><summary>" << title << "</summary>\n";
    page << "<section id=\"" << section.id << "\">\n" << (folded ? "" : title + "\n");
    section.write(study, writer);
    page << "</section>\n" << (folded ? "</details>\n" : "");
}

void write_replays(const Replays& replays, std::ostream& page) {
    page << "<section id=\"replays\">\n<h2>Replays</h2>\n<p>Of each scenario the trip of an emergency "
            "vehicle with "
            "the median gain, the best and the worst, beside the baseline of the same seed.</p>\n"
         << replays.markup << "</section>\n";
}

}  // namespace

void write_html(const StudyFacts& study, std::ostream& page, const Replays& replays) {
    const std::string title = escaped(study.title);
    write_head(title, replays, page);
    page << "<header>\n<h1>" << title << "</h1>\n";
    std::string navigation;
    for (const Section& section : detail::sections()) {
        if (section.applies(study))
            navigation += fmt::format("<a href=\"#{}\">{}</a>", section.id, section.title);
    }
    if (!replays.markup.empty()) navigation += "<a href=\"#replays\">Replays</a>";
    page << "<nav aria-label=\"Sections\">" << navigation << "</nav>\n</header>\n<main>\n";
    detail::PageWriter writer(page);
    for (const Section& section : detail::sections()) {
        if (section.applies(study)) write_section(section, study, page, writer);
    }
    if (!replays.markup.empty()) write_replays(replays, page);
    page << "</main>\n<footer>Means of replications with 95 % intervals. EV: emergency vehicle.</footer>\n"
            "<script>"
         << detail::script_text << "</script>\n</body>\n</html>\n";
}

}  // namespace clearway::report
