#pragma once

#include <string>
#include <vector>

#include "training/trainer.hpp"

namespace clearway::training {

/// The train-test curve (Fig. 4 of the dissertation) as a self-contained SVG image of 640 x 400: losses over
/// epochs, counted from 1 as published, with axes and a legend that names the second curve `held_out_label`.
/// Losses that are not finite leave a gap. The vertical axis starts at 0. Pure; equal losses give equal
/// bytes.
std::string loss_curve_svg(const std::vector<EpochLoss>& losses, const std::string& held_out_label);

}  // namespace clearway::training
