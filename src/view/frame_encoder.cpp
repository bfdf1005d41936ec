#include "view/frame_encoder.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <iterator>
#include <utility>

namespace clearway::view {
namespace {

using detail::Ascending;
using detail::ByteWriter;

/// Milliseconds: SUMO's clock.
std::uint64_t milliseconds(double time_s) {
    return static_cast<std::uint64_t>(std::llround(time_s * 1000.0));
}

/// The shorter way round from one heading to another, [-128, 127].
int turn(std::uint8_t from, std::uint8_t to) {
    return static_cast<std::int8_t>(static_cast<std::uint8_t>(to - from));
}

/// Slots of `some` that `others` lacks, with their count before them.
void write_missing(const std::vector<SeenVehicle>& some, const std::vector<SeenVehicle>& others,
                   ByteWriter& writer) {
    std::vector<SeenVehicle> missing;
    std::ranges::set_difference(some, others, std::back_inserter(missing), {}, &SeenVehicle::slot,
                                &SeenVehicle::slot);
    writer.number(missing.size());
    Ascending slots(writer);
    for (const SeenVehicle& vehicle : missing)
        slots.write(vehicle.slot);
}

void write_link_list(const std::vector<Link>& links, ByteWriter& writer) {
    writer.number(links.size());
    Slot one = 0;
    Slot other = 0;
    for (const Link& link : links) {
        assert(link.one >= one && link.one < link.other);
        if (link.one != one) other = link.one;
        writer.number(link.one - one);
        writer.number(link.other - other);
        one = link.one;
        other = link.other;
    }
}

std::vector<Link> without(const std::vector<Link>& links, const std::vector<Link>& others) {
    std::vector<Link> rest;
    std::ranges::set_difference(links, others, std::back_inserter(rest));
    return rest;
}

void write_marks(const Frame& frame, ByteWriter& writer) {
    writer.number(frame.marks.size());
    for (const Mark& mark : frame.marks) {
        writer.byte(static_cast<std::uint8_t>(mark.kind));
        assert(mark.time_s <= frame.time_s);
        writer.number(milliseconds(frame.time_s) - milliseconds(mark.time_s));
        writer.number(mark.vehicle);
        writer.number(mark.other);
    }
}

}  // namespace

void FrameEncoder::append_block(BlockKind kind, std::string_view content, std::string& stream) {
    ByteWriter head;
    head.byte(static_cast<std::uint8_t>(kind));
    head.number(content.size());
    stream.append(head.bytes()).append(content);
}

void FrameEncoder::encode(const Names& names, std::string& stream) {
    ByteWriter writer;
    writer.number(names.vehicles.size());
    for (const NamedVehicle& vehicle : names.vehicles) {
        writer.byte(vehicle.vehicle_class);
        writer.byte(vehicle.kind);
        writer.number(vehicle.length);
        writer.number(vehicle.width);
        writer.text(vehicle.id);
    }
    writer.number(names.texts.size());
    for (const std::string& text : names.texts)
        writer.text(text);
    writer.number(names.ways.size());
    for (const std::vector<std::uint32_t>& way : names.ways) {
        writer.number(way.size());
        // Edges that follow each other often have numbers near each other.
        std::int64_t last = 0;
        for (const std::uint32_t edge : way)
            writer.signed_number(edge - std::exchange(last, edge));
    }
    append_block(BlockKind::names, writer.bytes(), stream);
}

void FrameEncoder::encode_message(std::string_view json, std::string& stream) {
    append_block(BlockKind::message, json, stream);
}

void FrameEncoder::encode_key(const Frame& frame, std::string& stream) {
    last_ = Frame();
    last_motion_.clear();
    encode(frame, BlockKind::key, stream);
}

void FrameEncoder::encode_delta(const Frame& frame, std::string& stream) {
    encode(frame, BlockKind::delta, stream);
}

void FrameEncoder::encode(const Frame& frame, BlockKind kind, std::string& stream) {
    writer_.clear();
    writer_.number(milliseconds(frame.time_s));
    write_vehicles(frame);
    write_signals(frame);
    write_links(frame);
    write_ghosts(frame);
    write_leases(frame);
    write_ways(frame);
    write_known_blocks(frame);
    write_marks(frame, writer_);
    append_block(kind, writer_.bytes(), stream);
    last_ = frame;
}

void FrameEncoder::write_vehicles(const Frame& frame) {
    write_missing(last_.vehicles, frame.vehicles, writer_);
    write_missing(frame.vehicles, last_.vehicles, writer_);
    std::vector<const SeenVehicle*> before;
    before.reserve(frame.vehicles.size());
    auto last = last_.vehicles.begin();
    for (const SeenVehicle& vehicle : frame.vehicles) {
        while (last != last_.vehicles.end() && last->slot < vehicle.slot)
            ++last;
        const bool known = last != last_.vehicles.end() && last->slot == vehicle.slot;
        before.push_back(known ? &*last : nullptr);
    }
    write_columns(frame, before);
}

/// One column after the other, because like numbers next to each other compress better.
void FrameEncoder::write_columns(const Frame& frame, const std::vector<const SeenVehicle*>& before) {
    assert(before.size() == frame.vehicles.size() && last_motion_.size() == last_.vehicles.size());
    static const SeenVehicle nowhere;
    const auto each = [&](const auto& write) {
        for (std::size_t i = 0; i < frame.vehicles.size(); ++i)
            write(i, frame.vehicles[i], before[i] != nullptr ? *before[i] : nowhere);
    };
    const auto motion_before = [&](std::size_t i) {
        return before[i] == nullptr
                   ? Motion{}
                   : last_motion_[static_cast<std::size_t>(before[i] - last_.vehicles.data())];
    };
    std::vector<Motion> motion(frame.vehicles.size());
    each([&](std::size_t i, const SeenVehicle& now, const SeenVehicle& then) {
        if (before[i] != nullptr) motion[i] = {now.x - then.x, now.y - then.y};
        writer_.signed_number(now.x - then.x - motion_before(i).x);
    });
    each([&](std::size_t i, const SeenVehicle& now, const SeenVehicle& then) {
        writer_.signed_number(now.y - then.y - motion_before(i).y);
    });
    each([&](std::size_t, const SeenVehicle& now, const SeenVehicle& then) {
        writer_.signed_number(turn(then.heading, now.heading));
    });
    each([&](std::size_t, const SeenVehicle& now, const SeenVehicle& then) {
        writer_.signed_number(now.speed - then.speed);
    });
    std::vector<std::uint32_t> toggled;
    each([&](std::size_t i, const SeenVehicle& now, const SeenVehicle& then) {
        if (now.dark != then.dark) toggled.push_back(static_cast<std::uint32_t>(i));
    });
    writer_.number(toggled.size());
    Ascending rows(writer_);
    for (const std::uint32_t row : toggled)
        rows.write(row);
    last_motion_ = std::move(motion);
}

void FrameEncoder::write_signals(const Frame& frame) {
    std::vector<std::uint32_t> changed;
    for (std::uint32_t signal = 0; signal < frame.signals.size(); ++signal) {
        if (signal >= last_.signals.size() || last_.signals[signal] != frame.signals[signal])
            changed.push_back(signal);
    }
    writer_.number(changed.size());
    Ascending numbers(writer_);
    for (const std::uint32_t signal : changed) {
        numbers.write(signal);
        writer_.text(frame.signals[signal]);
    }
}

void FrameEncoder::write_links(const Frame& frame) {
    for (std::size_t layer = 0; layer < layers; ++layer) {
        write_link_list(without(last_.links[layer], frame.links[layer]), writer_);
        write_link_list(without(frame.links[layer], last_.links[layer]), writer_);
    }
}

/// All of them or, where nothing changed, a 0.
void FrameEncoder::write_ghosts(const Frame& frame) {
    if (frame.ghosts == last_.ghosts) return writer_.number(0);
    writer_.number(frame.ghosts.size() + 1);
    Ascending slots(writer_);
    for (const Ghost& ghost : frame.ghosts) {
        slots.write(ghost.slot);
        writer_.signed_number(ghost.x);
        writer_.signed_number(ghost.y);
        writer_.number(ghost.sigma);
        writer_.number(ghost.age);
    }
}

void FrameEncoder::write_leases(const Frame& frame) {
    if (frame.leases == last_.leases) return writer_.number(0);
    writer_.number(frame.leases.size() + 1);
    for (const SeenLease& lease : frame.leases) {
        writer_.byte(lease.on_signal ? 1 : 0);
        writer_.number(lease.target);
        writer_.byte(lease.action);
        writer_.signed_number(lease.amount);
        writer_.number(lease.policy);
        writer_.number(lease.reason);
        writer_.number(lease.beneficiary);
    }
}

void FrameEncoder::write_ways(const Frame& frame) {
    if (frame.ways == last_.ways) return writer_.number(0);
    writer_.number(frame.ways.size() + 1);
    Ascending slots(writer_);
    for (const SeenWay& seen : frame.ways) {
        slots.write(seen.slot);
        writer_.number(seen.way);
        writer_.number(seen.at);
    }
}

void FrameEncoder::write_known_blocks(const Frame& frame) {
    if (frame.known_blocks == last_.known_blocks) return writer_.number(0);
    writer_.number(frame.known_blocks.size() + 1);
    Ascending edges(writer_);
    for (const std::uint32_t edge : frame.known_blocks)
        edges.write(edge);
}

}  // namespace clearway::view
