#pragma once

#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "campaign/printing.hpp"
#include "campaign/publication.hpp"
#include "core/error.hpp"
#include "experiment/loop_config.hpp"
#include "links/link_plan.hpp"
#include "scenario/config.hpp"

namespace clearway::campaign {

/// Which predictors are judged, on which links. Names are those of the user and are checked.
struct LinkRequest {
    std::vector<std::string> scenarios;
    std::string benchmark;
    std::vector<std::string> failures;
    std::vector<std::string> predictors;
    std::vector<std::pair<std::string, std::string>>
        settings;                                             ///< `link_threshold`, `kalman.link_threshold`.
    std::vector<std::pair<std::string, std::string>> models;  ///< Files by predictor.
    std::string exits = "both";
    std::uint64_t study_seed = 1;
    links::SeedRange test{0, 10};
    links::SeedRange validation{1000, 5};
    bool quick = false;
    links::LinkSplit split = links::LinkSplit::test;
    std::string against;
    std::string folder;
    unsigned workers = 0;
    Publication publication;  ///< Its file may be empty.
    Printing printing = Printing::text;
    experiment::LinkSettings links;
    scenario::Options options;
    std::string command;  ///< What the user typed.
};

/// Makes the runs that are missing in the folder, judges the predictors, writes evaluation.json,
/// evaluation.csv and links.html and prints the tables. Returns ok, or why runs are missing. Throws
/// core::InputError with all problems.
core::ExitCode evaluate_links(const LinkRequest& request);

}  // namespace clearway::campaign
