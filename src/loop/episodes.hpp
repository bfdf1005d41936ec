#pragma once

#include <cstdint>
#include <filesystem>

#include "core/error.hpp"
#include "python/channel.hpp"

namespace clearway::loop {

/// Serves the episodes of an environment (python/clearway/environment.py) until its pipe ends: loads and
/// warms up the simulation of a run job once, and forks a child for every reset, which runs the job's only
/// condition with a policy::Agent that asks the environment. An episode is a run: what is not decided by the
/// agent is decided as there. The agent is offered up to `ways` ways (at most policy::most_agent_ways).
/// Results are handed over at the end and stored nowhere. Throws as work_on does before the first episode.
core::ExitCode serve_episodes(const std::filesystem::path& job_file, const python::Descriptors& descriptors,
                              std::uint32_t ways);

}  // namespace clearway::loop
