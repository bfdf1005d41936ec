#include "report/detail/plain_page.hpp"

#include "report/detail/style.hpp"
#include "report/text.hpp"

namespace clearway::report::detail {

void write(const PlainPage& plain, std::ostream& page) {
    const std::string title = escaped(plain.title);
    page << "<!DOCTYPE html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n"
            "<meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n"
            "<meta http-equiv=\"Content-Security-Policy\" content=\"default-src 'none'; style-src "
            "'unsafe-inline'; img-src data:\">\n<link rel=\"icon\" href=\"data:,\">\n<title>"
         << title << "</title>\n<style>" << page_style() << "</style>\n</head>\n<body>\n<header>\n<h1>"
         << title << "</h1>\n<p class=\"lead\">" << escaped(plain.lead)
         << "</p>\n<nav aria-label=\"Sections\">";
    for (const PageSection& section : plain.sections)
        page << "<a href=\"#" << section.id << "\">" << section.title << "</a>";
    page << "</nav>\n</header>\n<main>\n";
    for (const PageSection& section : plain.sections)
        page << "<section id=\"" << section.id << "\">\n<h2>" << section.title << "</h2>\n"
             << section.body << "</section>\n";
    page << "</main>\n<footer>" << escaped(plain.footer) << "</footer>\n</body>\n</html>\n";
}

}  // namespace clearway::report::detail
