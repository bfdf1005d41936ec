#pragma once

#include "drivers/config.hpp"

namespace clearway::experiment {

/// How human drivers react to a siren.
struct Sirens {
    drivers::SirenConfig siren;
    drivers::ReactionConfig reaction;
};

}  // namespace clearway::experiment
