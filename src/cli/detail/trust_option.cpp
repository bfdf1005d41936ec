#include "cli/detail/trust_option.hpp"

namespace clearway::cli {

void add_trust_option(App& app, campaign::CodeTrust& trust) {
    app.add_flag_callback(
        "--trust-code", [&trust] { trust = campaign::CodeTrust::trusted; },
        "Run code in Python that the folder names, with your rights; without it runs with such code are "
        "refused [off]");
}

}  // namespace clearway::cli
