#include "view/frame_encoder.hpp"

#include <array>
#include <fstream>
#include <random>
#include <sstream>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "core/files.hpp"

namespace clearway::view {
namespace {

std::string hex(const std::string& bytes) {
    std::string text;
    for (const char byte : bytes)
        text += fmt::format("{:02x}", static_cast<unsigned char>(byte));
    return text;
}

Frame first_frame() {
    Frame frame;
    frame.time_s = 100.25;
    frame.vehicles = {{0, 1000, 20, 0, 139, false}, {1, 40, 6000, 250, 0, true}, {7, 5, 5, 64, 3, false}};
    frame.signals = {"GGrr", "", "rg"};
    frame.links[0] = {{0, 1}, {0, 7}, {1, 7}};
    frame.links[2] = {{0, 7}};
    frame.ghosts = {{1, 55, 6010, 83, 25}};
    frame.leases = {{true, 2, 5, 4, 0, 1, 1}, {false, 7, 0, 105, 0, 2, 0}};
    frame.ways = {{0, 0, 2}, {7, 1, 0}};
    frame.known_blocks = {9, 300};
    frame.marks = {{MarkKind::request, 100.0, 1, 3}, {MarkKind::departure, 100.25, 1, 0}};
    return frame;
}

/// The first vehicle drives on, the second is gone, a new one has come; half of the links are gone.
Frame second_frame() {
    Frame frame = first_frame();
    frame.time_s = 100.5;
    frame.vehicles = {{0, 1035, 19, 255, 141, true}, {3, -12, 300, 128, 50, false}, {7, 5, 5, 64, 0, false}};
    frame.signals[2] = "Gg";
    frame.links[0] = {{0, 7}};
    frame.links[1] = {{0, 3}, {3, 7}};
    frame.leases.pop_back();
    frame.ways = {{0, 1, 3}};
    frame.known_blocks = {300};
    frame.marks = {{MarkKind::grant, 100.5, 1, 3}, {MarkKind::collision, 100.5, 8, 4}};
    return frame;
}

/// Nothing but motion: as extrapolated for the first vehicle.
Frame third_frame() {
    Frame frame = second_frame();
    frame.time_s = 100.75;
    frame.vehicles[0].x = 1070;
    frame.vehicles[0].y = 18;
    frame.vehicles[1].x = -30;
    frame.marks.clear();
    return frame;
}

std::string golden_stream() {
    std::string stream;
    FrameEncoder encoder;
    FrameEncoder::encode({.vehicles = {{"ambulance <1>", 2, 4, 65, 22}, {"h\xc3\xa4ndler", 0, 0, 50, 18}},
                          .texts = {"green_wave", "ahead of the ambulance", "keep clear"},
                          .ways = {{5, 6, 200, 3}, {}}},
                         stream);
    encoder.encode_key(first_frame(), stream);
    encoder.encode_delta(second_frame(), stream);
    encoder.encode_delta(third_frame(), stream);
    encoder.encode_key(third_frame(), stream);
    FrameEncoder::encode_message(R"({"ended":true})", stream);
    return stream;
}

/// page/tests/stream.test.mjs decodes the same bytes and compares them with the frames above, written down a
/// second time.
TEST(FrameEncoder, writes_the_bytes_that_the_page_reads) {
    const std::string file = CLEARWAY_SOURCE_DIR "/page/tests/golden_stream.hex";
    std::string golden = core::read_file(file);
    std::erase(golden, '\n');
    EXPECT_EQ(hex(golden_stream()), golden)
        << "If the format was changed on purpose, raise stream_format and "
           "put these bytes into "
        << file;
}

/// 5,000 vehicles that accelerate, brake and turn, 20 frames a second, with key frames as a stream has them.
TEST(FrameEncoder, five_thousand_vehicles_at_20_frames_a_second_take_less_than_2_megabytes_a_second) {
    constexpr std::size_t vehicles = 5000;
    constexpr int seconds = 10;
    constexpr int rate = 20;
    std::mt19937 draw(7);
    std::normal_distribution<double> acceleration_mps2(0.0, 1.5);
    std::uniform_real_distribution<double> place_m(0.0, 5000.0);
    struct Driving {
        double x_m, y_m, speed_mps, heading;
    };
    std::vector<Driving> driving(vehicles);
    for (Driving& each : driving)
        each = {place_m(draw), place_m(draw), 14.0, place_m(draw)};
    std::string stream;
    FrameEncoder encoder;
    for (int step = 0; step < seconds * rate; ++step) {
        Frame frame;
        frame.time_s = static_cast<double>(step) / rate;
        for (Slot slot = 0; slot < vehicles; ++slot) {
            Driving& each = driving[slot];
            each.speed_mps = std::clamp(each.speed_mps + acceleration_mps2(draw) / rate, 0.0, 20.0);
            each.heading += 0.01;
            each.x_m += each.speed_mps / rate * std::cos(each.heading);
            each.y_m += each.speed_mps / rate * std::sin(each.heading);
            frame.vehicles.push_back(
                {slot, static_cast<std::int32_t>(each.x_m * 10), static_cast<std::int32_t>(each.y_m * 10),
                 static_cast<std::uint8_t>(std::lround(each.heading * 40.7)),
                 static_cast<std::int32_t>(each.speed_mps * 10), (slot + step) % 50 == 0});
        }
        step % (5 * rate) == 0 ? encoder.encode_key(frame, stream) : encoder.encode_delta(frame, stream);
    }
    const std::size_t bytes_per_second = stream.size() / seconds;
    RecordProperty("bytes_per_second", std::to_string(bytes_per_second));
    EXPECT_LT(bytes_per_second, 2'000'000U);
    EXPECT_GT(bytes_per_second, vehicles * rate * 4U) << "every vehicle takes four bytes at least";
}

}  // namespace
}  // namespace clearway::view
