#include "roads/detail/network_builder.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <string_view>
#include <utility>

#include <fmt/format.h>

#include "roads/controllers.hpp"
#include "roads/detail/numbers.hpp"
#include "roads/permissions.hpp"

namespace clearway::roads {
namespace {

constexpr std::size_t most_problems = 20;
constexpr double any = std::numeric_limits<double>::max();

bool is_inside_junction(std::string_view function) {
    return function == "internal" || function == "crossing" || function == "walkingarea";
}

float length_of(const std::vector<Point>& shape) {
    double sum = 0.0;
    for (std::size_t i = 1; i < shape.size(); ++i) {
        sum += std::hypot(shape[i].x_m - shape[i - 1].x_m, shape[i].y_m - shape[i - 1].y_m);
    }
    return static_cast<float>(sum);
}

std::vector<std::string> words_of(std::string_view text) {
    std::vector<std::string> words;
    detail::for_each_word(text, ' ', [&](std::string_view word) { words.emplace_back(word); });
    return words;
}

/// netconvert escapes names that are escaped already: `d&apos;Ostende` becomes `d&amp;apos;Ostende`.
std::string street_name(std::string_view read) {
    constexpr std::array<std::pair<std::string_view, const char*>, 3> letters = {
        {{"&apos;", "'"}, {"&quot;", "\""}, {"&amp;", "&"}}};
    std::string name(read);
    for (const auto& [escaped, letter] : letters) {
        for (std::size_t at = name.find(escaped); at != std::string::npos; at = name.find(escaped, at + 1))
            name.replace(at, escaped.size(), letter);
    }
    return name;
}

}  // namespace

void NetworkBuilder::begin_additional(const std::filesystem::path& file) {
    file_ = file.string();
    in_additional_ = true;
}

/// Railway signals do not count as known.
bool NetworkBuilder::is_known_program(std::string_view element, const core::XmlAttributes& attributes) const {
    return element == "tlLogic" && network_.find_signal(attributes.find("id").value_or(""));
}

void NetworkBuilder::start(std::string_view element, const core::XmlAttributes& attributes,
                           unsigned long line) {
    line_ = line;
    ++depth_;
    if (depth_ == 1) {
        if (!in_additional_ && element != "net") {
            throw core::InputError(
                {fmt::format("{}:{}", file_, line),
                 fmt::format("is not a SUMO network: its outermost element is <{}>", element), "<net>",
                 "Name a .net.xml file as netconvert writes it"});
        }
        return;
    }
    if (depth_ == 2) {
        in_program_ = in_additional_ ? is_known_program(element, attributes) : element == "tlLogic";
        if (in_program_) read_program(attributes);
        if (in_additional_) return;
        in_edge_ = element == "edge";
        in_junction_ = element == "junction";
        if (in_edge_) read_edge(attributes);
        if (in_junction_) read_junction(attributes);
        if (element == "location") read_location(attributes);
        if (element == "connection") read_connection(attributes);
        if (element == "roundabout") read_roundabout(attributes);
        return;
    }
    if (in_edge_ && element == "lane") read_lane(attributes);
    if (in_program_ && element == "phase") read_phase(attributes);
    if (in_junction_ && element == "request") read_request(attributes);
}

void NetworkBuilder::end(std::string_view) {
    if (depth_ == 2 && in_edge_) end_edge();
    if (depth_ == 2 && in_program_) end_program();
    --depth_;
}

void NetworkBuilder::add_problem(std::string what, std::string allowed, std::string cure) {
    add_problem({fmt::format("{}:{}", file_, line_), std::move(what), std::move(allowed), std::move(cure)});
}

void NetworkBuilder::add_problem(core::Problem problem) {
    problems_.push_back(std::move(problem));
    if (problems_.size() < most_problems) return;
    problems_.push_back({file_, "has more problems, which are not listed", "",
                         "Make the network with netconvert and do not edit it by hand"});
    throw core::InputError(std::move(problems_));
}

double NetworkBuilder::number_or(const core::XmlAttributes& attributes, const char* name, double minimum,
                                 double maximum, double missing) {
    return attributes.find(name) ? number(attributes, name, minimum, maximum) : missing;
}

double NetworkBuilder::number(const core::XmlAttributes& attributes, const char* name, double minimum,
                              double maximum) {
    const std::string_view given = attributes.find(name).value_or("");
    const auto value = detail::parse_number(given);
    if (value && *value >= minimum && *value <= maximum) return *value;
    add_problem(fmt::format("{}=\"{}\"", name, given),
                maximum == any ? fmt::format("a number from {}", minimum)
                               : fmt::format("a number from {} to {}", minimum, maximum));
    return 0.0;
}

std::string NetworkBuilder::text(const core::XmlAttributes& attributes, const char* name) {
    const auto value = attributes.find(name);
    if (!value || value->empty()) add_problem(fmt::format("lacks the attribute {}", name));
    return std::string(value.value_or(""));
}

std::vector<Point> NetworkBuilder::shape(const core::XmlAttributes& attributes) {
    const std::string_view given = attributes.find("shape").value_or("");
    std::vector<Point> points;
    bool sound = true;
    detail::for_each_word(given, ' ', [&](std::string_view word) {
        const std::size_t comma = word.find(',');
        const auto x = detail::parse_number(word.substr(0, comma));
        const std::string_view rest =
            comma == std::string_view::npos ? std::string_view{} : word.substr(comma + 1);
        const auto y = detail::parse_number(rest.substr(0, rest.find(',')));
        sound = sound && x && y;
        if (x && y) points.push_back({static_cast<float>(*x), static_cast<float>(*y)});
    });
    if (!sound || points.size() < 2) {
        add_problem(fmt::format("shape=\"{}\"", given.substr(0, 60)), "two or more points x,y");
        points.assign(2, Point{});
    }
    return points;
}

void NetworkBuilder::read_location(const core::XmlAttributes& attributes) {
    std::vector<double> numbers;
    const std::string given = text(attributes, "netOffset") + "," + text(attributes, "convBoundary");
    detail::for_each_word(given, ',', [&](std::string_view word) {
        const auto value = detail::parse_number(word);
        if (value) numbers.push_back(*value);
    });
    if (numbers.size() != 6) {
        add_problem(fmt::format("location {}", given),
                    "netOffset of two numbers and convBoundary of four, with commas");
        return;
    }
    network_.location_ = {numbers[0], numbers[1], text(attributes, "projParameter"), numbers[2], numbers[3],
                          numbers[4], numbers[5]};
}

void NetworkBuilder::read_edge(const core::XmlAttributes& attributes) {
    Edge edge;
    edge.id = text(attributes, "id");
    edge.name = street_name(attributes.find("name").value_or(""));
    edge.type = attributes.find("type").value_or("");
    const std::string_view function = attributes.find("function").value_or("");
    edge.internal = is_inside_junction(function);
    edge.crossing = function == "crossing";
    edge.walking_area = function == "walkingarea";
    if (!edge.internal) {
        edge.from_junction = text(attributes, "from");
        edge.to_junction = text(attributes, "to");
    }
    edge.priority = static_cast<int>(number_or(attributes, "priority", -1e6, 1e6, 0.0));
    edge.first_lane = static_cast<std::uint32_t>(network_.lanes_.size());
    const auto row = static_cast<std::uint32_t>(network_.edges_.size());
    if (!network_.edge_rows_.try_emplace(edge.id, row).second) {
        add_problem(fmt::format("edge \"{}\" occurs twice", edge.id));
    }
    network_.edges_.push_back(std::move(edge));
}

void NetworkBuilder::read_lane(const core::XmlAttributes& attributes) {
    Edge& edge = network_.edges_.back();
    Lane lane;
    lane.id = text(attributes, "id");
    lane.edge = core::EdgeIndex{static_cast<std::uint32_t>(network_.edges_.size() - 1)};
    lane.number = static_cast<std::uint32_t>(number(attributes, "index", 0, 1000));
    // Netconvert 1.22 and newer repeat the index inside junctions; ids count on.
    if (edge.internal && lane.id == fmt::format("{}_{}", edge.id, edge.lane_count))
        lane.number = edge.lane_count;
    if (lane.number != edge.lane_count) {
        add_problem(fmt::format("index=\"{}\" of lane \"{}\"", lane.number, lane.id),
                    std::to_string(edge.lane_count),
                    "write the network again: netconvert --sumo-net-file OLD --output-file NEW");
    }
    lane.length_m = static_cast<float>(number(attributes, "length", 0, 1e7));
    lane.speed_limit_mps = static_cast<float>(number(attributes, "speed", 0, 1e3));
    lane.width_m = static_cast<float>(number_or(attributes, "width", 0, 1e3, 3.2));
    const Permissions allowed = permissions_of(attributes);
    lane.allows_cars = allowed.cars;
    lane.allows_emergency = allowed.emergency;
    lane.allows_pedestrians = allowed.pedestrians;
    lane.shape = shape(attributes);
    lane.shape_length_m = length_of(lane.shape);
    const auto row = static_cast<std::uint32_t>(network_.lanes_.size());
    if (!network_.lane_rows_.try_emplace(lane.id, row).second) {
        add_problem(fmt::format("lane \"{}\" occurs twice", lane.id));
    }
    if (edge.lane_count == 0) edge.length_m = lane.length_m;
    ++edge.lane_count;
    network_.lanes_.push_back(std::move(lane));
}

void NetworkBuilder::end_edge() {
    in_edge_ = false;
    const Edge& edge = network_.edges_.back();
    if (edge.lane_count == 0) add_problem(fmt::format("edge \"{}\" has no lane", edge.id));
}

void NetworkBuilder::read_program(const core::XmlAttributes& attributes) {
    const std::string id = text(attributes, "id");
    const auto row = static_cast<std::uint32_t>(network_.signals_.size());
    const auto [entry, is_new] = network_.signal_rows_.try_emplace(id, row);
    if (is_new) {
        network_.signals_.emplace_back();
        network_.signals_.back().id = id;
    }
    program_signal_ = &network_.signals_[entry->second];
    program_id_ = attributes.find("programID").value_or("");
    program_offset_s_.reset();
    if (attributes.find("offset")) program_offset_s_ = number_or(attributes, "offset", -any, any, 0.0);
    has_type_ = attributes.find("type").has_value();
    controller_ = attributes.find("type").value_or("static");
    is_fixed_time_ = controller_ == "static";
    has_target_phase_ = false;
    program_place_ = fmt::format("{}:{}", file_, line_);
    if (auto problem = controller_problem(program_place_, id, controller_)) add_problem(std::move(*problem));
    phases_.clear();
}

void NetworkBuilder::read_phase(const core::XmlAttributes& attributes) {
    Phase read{.duration_s = number(attributes, "duration", 0, any), .state = text(attributes, "state")};
    if (!is_fixed_time_) {
        read.least_s = number_or(attributes, "minDur", 0, any, 0.0);
        read.yellow_s = number_or(attributes, "yellow", 0, any, 0.0);
        read.red_s = number_or(attributes, "red", 0, any, 0.0);
    }
    read.name = attributes.find("name").value_or("");
    has_target_phase_ = has_target_phase_ || is_target_phase(attributes.find("type").value_or(""),
                                                             attributes.find("targetLanes").value_or(""));
    phases_.push_back(std::move(read));
    const Phase& phase = phases_.back();
    if (phase.state.size() != phases_.front().state.size()) {
        add_problem(fmt::format("state=\"{}\"", phase.state),
                    fmt::format("{} letters, as in the first phase", phases_.front().state.size()));
    }
}

/// Letters of a program beyond the last link that a connection names have no effect; SUMO only warns about
/// them.
std::size_t NetworkBuilder::letters_in_use(const Signal& signal) const {
    std::size_t letters = 0;
    for (const Connection& connection : network_.connections_) {
        if (connection.signal.exists() && &network_.signals_[connection.signal.value] == &signal)
            letters = std::max<std::size_t>(letters, connection.signal_link + 1U);
    }
    return letters;
}

/// SUMO takes a program of an additional file without `type` for another offset of a known program, and loads
/// no second one of the same id.
void NetworkBuilder::check_controller(const Signal& signal) {
    if (in_additional_ && program_id_ == signal.program_id)
        add_problem({program_place_,
                     fmt::format("a program of signal \"{}\" has the programID of the one before, \"{}\"",
                                 signal.id, program_id_),
                     "a programID of its own", "Change it, such as to programID=\"mine\""});
    if (in_additional_ && !has_type_)
        add_problem({program_place_,
                     fmt::format("a program of signal \"{}\" lacks the attribute type", signal.id),
                     core::listed(controllers()), "Write type=\"static\" for fixed times"});
    if (needs_target_phase(controller_) && !has_target_phase_)
        add_problem(target_phase_problem(program_place_, signal.id, controller_));
}

void NetworkBuilder::end_program() {
    in_program_ = false;
    Signal& signal = *program_signal_;
    if (in_additional_ && phases_.empty()) {  // another offset for an existing program
        if (program_id_ == signal.program_id) signal.offset_s = program_offset_s_.value_or(signal.offset_s);
        return;
    }
    if (phases_.empty()) {
        add_problem(fmt::format("signal \"{}\" has a program without phases", signal.id));
        return;
    }
    check_controller(signal);
    const std::size_t letters = phases_.front().state.size();
    const std::size_t in_use = in_additional_ ? letters_in_use(signal) : 0;
    if (letters < in_use) {
        add_problem(fmt::format("a program of signal \"{}\" with {} letters", signal.id, letters),
                    fmt::format("at least {}, the links of the network", in_use));
        return;
    }
    signal.links.resize(letters);
    signal.program = std::move(phases_);
    signal.program_id = program_id_;
    signal.offset_s = program_offset_s_.value_or(0.0);
    signal.fixed_time = is_fixed_time_;
    signal.controller = controller_;
}

void NetworkBuilder::read_junction(const core::XmlAttributes& attributes) {
    const std::string_view type = attributes.find("type").value_or("");
    in_junction_ = type != "internal" && type != "dead_end";
    if (type.starts_with("rail_")) railway_signals_.insert(text(attributes, "id"));
    if (!in_junction_) return;
    Junction junction;
    junction.incoming_lanes = words_of(attributes.find("incLanes").value_or(""));
    junction.inner_lanes = words_of(attributes.find("intLanes").value_or(""));
    junction.line = line_;
    junction.has_signal = type.starts_with("traffic_light");
    junctions_.push_back(std::move(junction));
}

void NetworkBuilder::read_request(const core::XmlAttributes& attributes) {
    Junction& junction = junctions_.back();
    const double index = number(attributes, "index", 0, 1e4);
    if (index != static_cast<double>(junction.foes.size())) {
        add_problem(fmt::format("request index=\"{}\"", index), std::to_string(junction.foes.size()));
    }
    junction.foes.push_back(text(attributes, "foes"));
    if (!junction.has_signal) junction.responses.emplace_back(attributes.find("response").value_or(""));
}

void NetworkBuilder::read_roundabout(const core::XmlAttributes& attributes) {
    for (const std::string& id : words_of(attributes.find("edges").value_or("")))
        if (const auto edge = network_.find_edge(id)) network_.edges_[edge->value].roundabout = true;
}

core::LaneIndex NetworkBuilder::connection_end(const core::XmlAttributes& attributes, const char* edge_name,
                                               const char* lane_name) {
    const std::string id = text(attributes, edge_name);
    const auto edge = network_.find_edge(id);
    if (!edge) {
        add_problem(fmt::format("{}=\"{}\" is not an edge defined above this line", edge_name, id));
        return core::LaneIndex::none();
    }
    const auto number_of_lane = static_cast<std::uint32_t>(number(attributes, lane_name, 0, 1000));
    const core::LaneIndex lane = network_.lane_of(*edge, number_of_lane);
    if (!lane.exists()) {
        add_problem(fmt::format("{}=\"{}\" of edge \"{}\"", lane_name, number_of_lane, id),
                    fmt::format("0 to {}", static_cast<int>(network_.edge(*edge).lane_count) - 1));
    }
    return lane;
}

void NetworkBuilder::read_connection(const core::XmlAttributes& attributes) {
    Connection connection;
    connection.from = connection_end(attributes, "from", "fromLane");
    connection.to = connection_end(attributes, "to", "toLane");
    if (!connection.from.exists() || !connection.to.exists()) return;
    Permissions allowed = permissions_of(attributes);
    if (const auto via = attributes.find("via")) {
        const auto lane = network_.find_lane(*via);
        if (!lane) {
            add_problem(fmt::format("via=\"{}\" is not a lane defined above this line", *via));
            return;
        }
        connection.via = *lane;
    }
    for (const core::LaneIndex part : {connection.from, connection.to, connection.via}) {
        if (!part.exists()) continue;
        allowed.cars = allowed.cars && network_.lane(part).allows_cars;
        allowed.emergency = allowed.emergency && network_.lane(part).allows_emergency;
    }
    connection.allows_cars = allowed.cars;
    connection.allows_emergency = allowed.emergency;
    const std::string_view direction = attributes.find("dir").value_or("");
    if (!direction.empty()) connection.direction = direction.front();
    set_signal(attributes, connection);
    network_.connections_.push_back(connection);
}

void NetworkBuilder::set_signal(const core::XmlAttributes& attributes, Connection& connection) {
    const auto id = attributes.find("tl");
    if (!id || railway_signals_.contains(std::string(*id))) return;
    const auto signal = network_.find_signal(*id);
    if (!signal) {
        add_problem(fmt::format("tl=\"{}\" is not a signal defined above this line", *id));
        return;
    }
    const std::size_t letters = network_.signal(*signal).links.size();
    const double link = number(attributes, "linkIndex", 0, 65535);
    if (link >= static_cast<double>(letters)) {
        add_problem(fmt::format("linkIndex=\"{}\" of signal \"{}\"", link, *id),
                    fmt::format("0 to {}, the letters of its phases", static_cast<long>(letters) - 1));
        return;
    }
    connection.signal = *signal;
    connection.signal_link = static_cast<std::uint16_t>(link);
}

}  // namespace clearway::roads
