#pragma once

#include <sstream>
#include <string>

#include "report/html.hpp"

namespace clearway::report::tests {

/// The whole page.
inline std::string page_of(const StudyFacts& study) {
    std::ostringstream page;
    write_html(study, page);
    return page.str();
}

/// The page without the one script that is the program's own: the last element of the body. Any other script
/// stays in the text.
inline std::string without_script(std::string page) {
    const std::size_t script = page.rfind("<script>");
    const std::string end = "</script>\n</body>\n</html>\n";
    if (script == std::string::npos || !page.ends_with(end))
        return "no script at the end of the body: <script";
    return page.erase(script, page.size() - end.size() + 10 - script);
}

}  // namespace clearway::report::tests
