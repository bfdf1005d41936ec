#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <unordered_set>
#include <vector>

#include "core/error.hpp"
#include "core/xml_stream.hpp"
#include "roads/network.hpp"

namespace clearway::roads {

/// Turns the elements of a network file, and the signal programs of additional files after it, into a
/// Network. Elements must come in SUMO's order: edges, signal programs, junctions, connections. Problems are
/// collected (at most 20) and thrown at the end.
class NetworkBuilder : public core::XmlHandler {
  public:
    explicit NetworkBuilder(const std::filesystem::path& file) : file_(file.string()) {}

    /// Everything read from now on comes from an additional file; only its programs for known signals count.
    void begin_additional(const std::filesystem::path& file);
    void start(std::string_view element, const core::XmlAttributes& attributes, unsigned long line) override;
    void end(std::string_view element) override;
    /// Does what needs the whole file. Throws core::InputError with all problems found.
    Network finish();

  private:
    /// A junction and its right-of-way table, kept until its ways are known.
    struct Junction {
        std::vector<std::string> incoming_lanes;
        std::vector<std::string> inner_lanes;  ///< One per request, empty in files without internal lanes.
        std::vector<std::string> foes;         ///< By request; the rightmost letter is request 0.
        std::vector<std::string> responses;    ///< Likewise; empty at signals.
        unsigned long line = 0;
        bool has_signal = false;
    };
    /// Position in the network's connections.
    using Row = std::uint32_t;
    static constexpr Row no_row = 0xffffffffU;

    bool is_known_program(std::string_view element, const core::XmlAttributes& attributes) const;
    void add_problem(std::string what, std::string allowed = {}, std::string cure = {});
    void add_problem(core::Problem problem);
    /// A required number; reports a missing, malformed or out-of-range one and returns 0.
    double number(const core::XmlAttributes& attributes, const char* name, double minimum, double maximum);
    double number_or(const core::XmlAttributes& attributes, const char* name, double minimum, double maximum,
                     double missing);
    std::string text(const core::XmlAttributes& attributes, const char* name);
    std::vector<Point> shape(const core::XmlAttributes& attributes);

    void read_location(const core::XmlAttributes& attributes);
    void read_edge(const core::XmlAttributes& attributes);
    void read_lane(const core::XmlAttributes& attributes);
    void end_edge();
    void read_program(const core::XmlAttributes& attributes);
    void read_phase(const core::XmlAttributes& attributes);
    void check_controller(const Signal& signal);
    void end_program();
    std::size_t letters_in_use(const Signal& signal) const;
    void read_junction(const core::XmlAttributes& attributes);
    void read_request(const core::XmlAttributes& attributes);
    void read_roundabout(const core::XmlAttributes& attributes);
    void read_connection(const core::XmlAttributes& attributes);
    void set_signal(const core::XmlAttributes& attributes, Connection& connection);
    core::LaneIndex connection_end(const core::XmlAttributes& attributes, const char* edge_name,
                                   const char* lane_name);

    void group_connections();
    void list_successors();
    void list_signal_links();
    void list_right_of_way();
    void list_foes(const Junction& junction, const std::vector<Row>& ways);
    void list_prior(const Junction& junction, const std::vector<Row>& ways,
                    std::vector<std::vector<Row>>& prior) const;
    void store_prior(const std::vector<std::vector<Row>>& prior);
    std::vector<Row> ways_by_request(const Junction& junction) const;
    std::vector<Row> ways_by_incoming_order(const Junction& junction) const;
    core::LaneIndex inner_lane_of(const Connection& connection) const;

    std::string file_;
    Network network_;
    std::vector<core::Problem> problems_;
    unsigned long line_ = 0;
    int depth_ = 0;
    bool in_additional_ = false;
    bool in_edge_ = false;
    bool in_program_ = false;
    bool in_junction_ = false;
    Signal* program_signal_ = nullptr;
    std::string program_id_;
    std::optional<double> program_offset_s_;
    std::string program_place_;  ///< File and line.
    std::string controller_;
    bool has_type_ = false;
    bool has_target_phase_ = false;
    bool is_fixed_time_ = false;
    std::vector<Phase> phases_;
    std::vector<Junction> junctions_;
    std::unordered_set<std::string> railway_signals_;
};

}  // namespace clearway::roads
