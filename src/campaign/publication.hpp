#pragma once

#include <string>
#include <vector>

#include "report/result_rows.hpp"
#include "results/store.hpp"

namespace clearway::campaign {

/// Where results are published, and what the user says about the tree that made them.
struct Publication {
    std::string file;       ///< A file of `results/`; empty: nothing is published.
    std::string tree;       ///< Commit; empty: the one that git names for the tree of this program.
    std::string behaviour;  ///< Fingerprint; empty: that of this tree's golden runs.
};

/// Writes the rows of a study. Throws core::InputError if it has one replication only, was made by another
/// build and the tree is not named, or if the file holds something else; core::EnvironmentError if the file
/// cannot be written. The file then stays as it was.
void publish_study(const Publication& publication, const results::Store& store,
                   const analysis::Summary& summary, const std::vector<std::string>& metrics);

/// Writes the rows of an evaluation of predictors that this program has just made.
void publish_links(const Publication& publication, const report::LinkFacts& facts);

}  // namespace clearway::campaign
