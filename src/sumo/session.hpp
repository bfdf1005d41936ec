#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "core/units.hpp"
#include "sumo/drawing.hpp"
#include "traffic/command.hpp"
#include "traffic/departure.hpp"
#include "traffic/vehicle.hpp"
#include "truth/events.hpp"
#include "truth/self_knowledge.hpp"
#include "truth/snapshot.hpp"

namespace clearway::sumo {

namespace detail::gateway {
class Sumo;
}

/// SUMO names by table row, so that the session can use indices of `roads::Network` without knowing it.
struct Names {
    std::vector<std::string> lanes;
    std::vector<std::string> edges;
    std::vector<std::string> signals;
};

struct SessionConfig {
    std::filesystem::path network;
    std::vector<std::filesystem::path> route_files;
    std::vector<std::filesystem::path> additional_files;
    std::filesystem::path folder;  ///< Receives tripinfo.xml and sumo.log.
    core::Seconds begin{0.0};
    core::Seconds step_length{0.25};        ///< [0.01, 1].
    std::uint64_t seed = 1;                 ///< For SUMO's own generator; reduced to 31 bits.
    core::Seconds time_to_teleport{300.0};  ///< Negative: never.
    /// A vehicle that has stood inside a junction this long no longer blocks it. Negative: it always does.
    core::Seconds ignore_junction_blocker{-1.0};
    std::vector<std::string> extra_arguments;  ///< As on SUMO's command line.
    Names names;
};

/// SUMO's arguments for a session, without the name of the program: `--net-file`, `...`. A session in this
/// process uses them itself. Throws core::InputError for settings that cannot work.
std::vector<std::string> command_line(const SessionConfig& config);

/// A SUMO that was started elsewhere with `--remote-port`, has its simulation loaded and waits for a client
/// (sumo-gui waits for its start button). It ends with the connection. One at a time per process.
class RemoteSumo {
  public:
    /// Connects, and waits for an answer up to `patience`. Throws core::EnvironmentError when nothing listens
    /// there, what listens does not speak TraCI, or its SUMO version is not the one that this program is
    /// built with.
    RemoteSumo(const std::string& host, int port, core::Seconds patience = core::Seconds(10.0));
    ~RemoteSumo();
    RemoteSumo(RemoteSumo&&) noexcept;
    RemoteSumo& operator=(RemoteSumo&&) noexcept;

    /// Value of an option of SUMO (`net-file`); empty when it is not set. Throws core::SimulatorError.
    std::string option(const std::string& name) const;
    /// Vehicles of this type have this class from now on. Other types have the class of their parameter
    /// (traffic::class_parameter); without one, those of SUMO's vClass emergency are emergency vehicles and
    /// the rest human. Throws core::InputError for a type that SUMO does not know.
    void declare(const std::string& type, traffic::VehicleClass vehicle_class);

  private:
    friend class Session;
    std::unique_ptr<detail::gateway::Sumo> sumo_;
};

/// SUMO in this process or at a port: at most one session at a time, used by one thread. Every fault of SUMO
/// is thrown as core::SimulatorError with the end of SUMO's log; after one, the session can only be
/// destroyed.
class Session : public truth::SelfKnowledge {
  public:
    /// Loads the scenario into a SUMO in this process. Throws core::SimulatorError when it does not load,
    /// core::EnvironmentError when SUMO or the folder is unusable.
    explicit Session(SessionConfig config);
    /// Takes over a running simulation with the vehicles that are in it. `folder` receives a log. A forked
    /// child cannot continue such a session.
    Session(RemoteSumo remote, const std::filesystem::path& folder, Names names);
    ~Session() override;

    /// Advances by one step, then reads the state and the events of that step.
    void step();
    core::Seconds time() const;
    /// Wall time of SUMO itself for the last step, without reading.
    core::Seconds step_wall_time() const;
    const truth::Snapshot& snapshot() const;
    const truth::Events& events() const;
    /// Every vehicle that ever departed, with class and kind from its type's parameters.
    const traffic::Roster& roster() const;
    /// Vehicles on the road, waiting to be inserted, or still to depart.
    int expected_vehicles() const;

    /// Adds an emergency vehicle that departs at `departure.depart` or later.
    void add(const traffic::EmergencyDeparture& departure);
    /// A vehicle that stands at `position` of a lane until it is removed, put there as soon as there is room.
    /// It is no traffic: it has no row, no entry in the roster, no trip and no count; contacts with it are
    /// collisions. Ids begin with traffic::obstacle_prefix.
    void add_obstacle(const std::string& id, core::LaneIndex lane, core::Metres position);
    bool has_obstacle(const std::string& id) const;
    void remove_obstacle(const std::string& id);
    /// Closes a lane to all but emergency vehicles, or opens it again to those who could use it before.
    void close_to_others(core::LaneIndex lane);
    void open_again(core::LaneIndex lane);
    /// Limits the speed on a lane where it is higher, or gives it its own limit again.
    void limit(core::LaneIndex lane, std::optional<core::MetresPerSecond> limit);
    /// Carries out commands. Throws std::invalid_argument for what SUMO would ignore silently (a lane that
    /// does not exist, NaN, a state of wrong length or letters); commands for vehicles that have left are
    /// skipped and counted.
    void apply(std::span<const traffic::Command> commands);
    std::uint64_t skipped_commands() const;
    /// Number of stops that were commanded when the vehicle could no longer brake in time on its lane.
    std::uint64_t refused_commands() const;
    /// SUMO's rerouting device of a vehicle, if it has one, changes its way no more.
    void stop_rerouting(core::VehicleKey vehicle);
    /// Lets a SUMO with a window show a drawing; without a window it has no effect.
    void draw(const Drawing& drawing);

    /// In a forked child, before anything else: moves SUMO's open outputs to the child's own files in
    /// `folder`, including what was written before the fork, so that each child's outputs equal those of an
    /// unforked run.
    void continue_in(const std::filesystem::path& folder);

    /// Ends the simulation so that all output files are complete. The destructor does it too, without
    /// throwing.
    void close();
    /// SUMO's table of trips, complete after `close`; an empty path when a remote SUMO writes none. A remote
    /// SUMO's path is as given there.
    const std::filesystem::path& trip_file() const;

    std::optional<bool> could_change_lane(core::VehicleKey vehicle,
                                          truth::Neighbour direction) const override;
    std::optional<std::vector<truth::LaneOutlook>> lane_outlook(core::VehicleKey vehicle) const override;
    std::optional<core::MetresPerSecond> allowed_speed(core::VehicleKey vehicle) const override;
    bool has_pedestrian(core::LaneIndex crossing) const override;
    /// Whether a vehicle on the road stands at a stop, planned or commanded.
    bool is_stopped(core::VehicleKey vehicle) const;
    std::string running_program(core::SignalIndex signal) const override;

  private:
    struct State;
    template <class Load>
    void open(Load&& load);

    std::unique_ptr<State> state_;
};

/// `1.15.0`, from the linked library.
std::string version();

}  // namespace clearway::sumo
