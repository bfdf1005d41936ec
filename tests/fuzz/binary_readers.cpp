// Readers of models, recordings and frames.
#include <fstream>

#include <netinet/in.h>
#include <sys/socket.h>
#include <unistd.h>

#include "core/error.hpp"
#include "fuzz/readers.hpp"
#include "prediction/detail/pickle.hpp"
#include "prediction/detail/zip.hpp"
#include "prediction/model_file.hpp"
#include "prediction/state_dict.hpp"
#include "prediction/weights.hpp"
#include "server/detail/hub.hpp"
#include "server/live_show.hpp"
#include "trace/detail/seal.hpp"
#include "trace/random_run.hpp"

namespace clearway::fuzz {
namespace {

using namespace std::string_literals;

std::vector<prediction::Tensor> two_tensors() {
    return {{"conv1.lin_l.weight", {2, 3}, {1.0F, 2.0F, 3.0F, 4.0F, 5.0F, 6.0F}},
            {"conv1.lin_l.bias", {2}, {0.5F, -0.5F}}};
}

/// The pickle of that state dict.
std::string pickle_of_tensors() {
    const std::string archive = prediction::format_pth(two_tensors(), "net");
    for (const prediction::detail::ZipEntry& member : prediction::detail::zip_entries(archive, "net.pth"))
        if (member.name.ends_with("data.pkl")) return std::string(member.content);
    throw std::logic_error("no pickle in a state dict");
}

/// Puts a pickle into an archive with right checksums, so that what it says reaches the tensors.
std::string archive_with(std::string_view pickle) {
    prediction::detail::ZipArchive archive;
    const std::string whole = prediction::format_pth(two_tensors(), "net");
    for (const prediction::detail::ZipEntry& member : prediction::detail::zip_entries(whole, "net.pth"))
        archive.add(member.name, member.name.ends_with("data.pkl") ? pickle : member.content);
    return std::move(archive).finish();
}

std::string recording() {
    const std::string file = scratch_file("written.h5", "");
    test::RandomRun run(1);
    trace::RecordingWriter writer(file, test::RandomRun::info());
    for (int step = 0; step < 3; ++step)
        writer.write(run.next());
    writer.finish();
    std::ifstream stream(file, std::ios::binary);
    return {std::istreambuf_iterator<char>(stream), {}};
}

/// Reads bytes as a recording whose seal is right.
void read_recording(std::string_view bytes) {
    const std::string file = scratch_file("read.h5", bytes);
    if (bytes.size() > trace::detail::seal_length) {
        const std::string seal = trace::detail::seal_of(file);
        std::fstream(file, std::ios::in | std::ios::out | std::ios::binary) << seal;
    }
    trace::RecordingReader reader(file);
    while (reader.next()) {
    }
}

/// Says bytes to a live server as a browser that has been let in, and hangs up.
void say_to_server(std::string_view bytes) {
    static server::LiveConfig config = [] {
        server::LiveConfig made;
        made.allow_control = true;
        return made;
    }();
    static server::LiveShow show(config);
    static const server::FakeRun run = show.run(0, "baseline");
    const int browser = ::socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0);
    sockaddr_in address{};
    address.sin_family = AF_INET;
    address.sin_port = htons(show.port());
    address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    if (::connect(browser, reinterpret_cast<const sockaddr*>(&address), sizeof address) != 0)
        throw std::logic_error("the server does not take a connection");
    static_cast<void>(::send(browser, bytes.data(), bytes.size(), MSG_NOSIGNAL));
    ::shutdown(browser, SHUT_WR);
    std::array<char, 4096> heard{};
    while (::recv(browser, heard.data(), heard.size(), 0) > 0) {
    }
    ::close(browser);
}

std::string request(const std::string& frames) {
    return "GET /live HTTP/1.1\r\nHost: 127.0.0.1\r\nUpgrade: websocket\r\nConnection: Upgrade\r\n"
           "Sec-WebSocket-Key: AAAAAAAAAAAAAAAAAAAAAA==\r\nSec-WebSocket-Version: 13\r\n\r\n" +
           frames;
}

/// Gives a hub one block after another: each kind, length and content.
void feed_hub(std::string_view bytes) {
    server::detail::Hub hub(2);
    while (bytes.size() >= 2) {
        const auto kind = static_cast<std::uint8_t>(bytes[0]);
        const std::size_t length =
            std::min<std::size_t>(static_cast<unsigned char>(bytes[1]), bytes.size() - 2);
        hub.take(kind & 1U, kind >> 1U, bytes.substr(2, length));
        bytes.remove_prefix(2 + length);
    }
    hub.beginning();
}

}  // namespace

std::vector<Reader> binary_readers() {
    const std::string pickle = pickle_of_tensors();
    const std::vector<std::string> opcodes = {"\x80\x02"s,
                                              "}"s,
                                              "("s,
                                              "u."s,
                                              "q\1"s,
                                              "h\1"s,
                                              "tR"s,
                                              "ctorch._utils\n_rebuild_tensor_v2\n"s,
                                              "X\xff\xff\xff\xff"s,
                                              "J\xff\xff\xff\x7f"s,
                                              "\x8a\x08\xff\xff\xff\xff\xff\xff\xff\x7f"s,
                                              "Q"s,
                                              "K\0"s};
    const std::string text = R"({"pace": 2})";
    const std::string frame = "\x81"s + static_cast<char>(0x80 | text.size()) + "\0\0\0\0"s + text;
    return {{"pickle",
             [](std::string_view bytes) { prediction::detail::read_pickle(bytes, "x.pkl"); },
             {pickle},
             opcodes},
            {"zip",
             [](std::string_view bytes) { prediction::parse_pth(bytes, "x.pth"); },
             {prediction::format_pth(two_tensors(), "net")},
             {"PK\1\2"s, "PK\3\4"s, "PK\5\6"s, "\xff\xff"s, "\xff\xff\xff\xff"s}},
            {"state_dict",
             [](std::string_view bytes) { prediction::parse_pth(archive_with(bytes), "x.pth"); },
             {pickle},
             opcodes},
            {"model",
             [](std::string_view bytes) {
                 prediction::read_model("graphsage_corrected", scratch_file("x.weights", bytes));
             },
             {source_file("src/prediction/models/graphsage_corrected.weights"),
              source_file("src/prediction/models/logistic.weights"),
              source_file("src/prediction/models/gat.weights")},
             {"nan", "inf", "1e999", "-1", "4294967295", "tensor", "\n", " "}},
            {"recording",
             read_recording,
             {recording()},
             {"\0\0\0\0\0\0\0\0"s, "\xff\xff\xff\xff\xff\xff\xff\xff"s}},
            {"web_socket",
             say_to_server,
             {request(frame), request("\x88\x82\0\0\0\0\x03\xe8"s), request("\x89\x80\0\0\0\0"s + frame)},
             {"\xff"s, "\x80"s, "\xfe\xff\xff"s, "\xff\xff\xff\xff\xff\xff\xff\xff\xff"s, "\r\n"s, "Host: "s,
              "Content-Length: 99"s}},
            {"hub",
             feed_hub,
             {"\x8\x2{}\x9\x2{}\x2\1a\4\1b\6\1c"s},
             {"{}"s, "{\"condition\": 1}"s, "\x80\x80\x80"s}}};
}

}  // namespace clearway::fuzz
