#pragma once

#include <span>
#include <stdexcept>
#include <string>

#include "core/settings.hpp"
#include "python/channel.hpp"
#include "python/nursery.hpp"
#include "python/part_name.hpp"
#include "python/sheet.hpp"
#include "roads/network.hpp"

namespace clearway::python {

enum class PartKind : std::uint8_t { policy, predictor };

/// What a part is told once, before its first question.
struct Greeting {
    PartKind kind = PartKind::policy;
    core::Settings settings = {};  ///< Keyword arguments of its class that differ from their defaults.
    std::span<const Column> question = {};  ///< Columns of the sheets that it will get.
    std::span<const Column> answer = {};    ///< Columns of its answers; none: it answers with text (JSON).
    const roads::Network* network = nullptr;
    double period_s = 0.0;
    double link_radius_m = 0.0;
};

/// The greeting as JSON: sheets, the network's lanes, edges and signals (numbers as in sheets).
std::string to_json(const PartName& name, const Greeting& greeting);

/// A Python process with one part of a condition. It is started for the process of a run, is CLEARWAY_PYTHON
/// (/usr/bin/python3) and ends with its owner (Host).
class PartProcess {
  public:
    /// Starts Python, loads the file and makes the part. Throws PartError with the traceback when that fails,
    /// PartLost where the machine failed, core::EnvironmentError when Python or the package is not there.
    PartProcess(const PartName& name, const Greeting& greeting);

    /// The sheet to fill before `ask`.
    Sheet& question() { return question_; }
    /// Asks and waits for the answer. Throws PartError with the traceback of an exception, or what became of
    /// the process; PartLost where the machine failed or killed it (SIGKILL).
    void ask();
    /// An array of the answer, valid until the next `ask`. Throws PartError when it lies outside the memory.
    template <class Value>
    std::span<const Value> answer_array(std::size_t column) const {
        try {
            return answer_.read<Value>(column);
        } catch (const std::out_of_range& error) {
            throw PartError(label_ + ": its answer: " + error.what());
        }
    }
    std::string answer_text() const { return channel_.read_text(); }

  private:
    void wait_for_answer();
    [[noreturn]] void report_end();

    std::string label_;
    Channel channel_;
    Sheet question_;
    Sheet answer_;
    Host host_;
};

/// Makes a part with its settings and lets it go: what the user is told before a study begins. Throws
/// core::InputError, saying `where`, with the traceback, or with the settings that the part has;
/// core::EnvironmentError where the machine failed.
void check_part(const PartName& name, PartKind kind, const core::Settings& settings,
                const std::string& where);

}  // namespace clearway::python
