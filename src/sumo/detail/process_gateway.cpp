#include "sumo/detail/api_gateway.hpp"

#if defined(__SANITIZE_ADDRESS__)
/// SUMO's XML parser leaks a few hundred bytes per load (LeakSanitizer reads this at exit, in every program
/// that links this module).
extern "C" const char* __lsan_default_suppressions();
extern "C" const char* __lsan_default_suppressions() {
    return "leak:libxerces-c\nleak:libicuuc\nleak:libsumocpp\n";
}
#endif

namespace clearway::sumo::detail::gateway {

std::unique_ptr<Sumo> in_this_process() {
    return std::make_unique<libsumo::ApiGateway>();
}

}  // namespace clearway::sumo::detail::gateway
