#include "experiment/run_key.hpp"

#include <fmt/format.h>

namespace clearway::experiment {

std::string to_text(const RunKey& key) {
    return fmt::format("{}/{}/{}", key.scenario, key.condition, key.replication);
}

}  // namespace clearway::experiment
