#include "core/fork_server.hpp"

#include <array>
#include <cerrno>
#include <csignal>
#include <cstdlib>
#include <cstring>
#include <utility>

#include <fcntl.h>
#include <sched.h>
#include <sys/prctl.h>
#include <sys/socket.h>
#include <sys/time.h>
#include <sys/wait.h>
#include <unistd.h>

#include "core/atomic_file.hpp"

namespace clearway::core {
namespace {

constexpr std::size_t longest_request = 2 * 4096 + 2;  // two paths
constexpr timeval longest_answer{.tv_sec = 60, .tv_usec = 0};

/// What comes back for a request.
struct Answer {
    pid_t pid = -1;
    int error = 0;              ///< Of errno, where there is no child.
    bool is_of_output = false;  ///< The error is that of opening the output.
};

/// A call that a signal may interrupt.
template <class Call>
ssize_t whole(const Call& call) {
    ssize_t result = 0;
    while ((result = call()) < 0 && errno == EINTR) {
    }
    return result;
}

/// Ends of a pipe that no program started later has.
class Pipe {
  public:
    Pipe() {
        if (pipe2(ends_.data(), O_CLOEXEC) != 0) ends_ = {-1, -1};  // then nothing is taken or given
    }
    ~Pipe() {
        close_end(0);
        close_end(1);
    }
    Pipe(const Pipe&) = delete;
    Pipe& operator=(const Pipe&) = delete;

    void close_end(std::size_t end) {
        if (ends_[end] >= 0) close(std::exchange(ends_[end], -1));
    }
    bool take(void* value, std::size_t size) const {
        return whole([&] { return read(ends_[0], value, size); }) == static_cast<ssize_t>(size);
    }
    bool give(const void* value, std::size_t size) const {
        return whole([&] { return write(ends_[1], value, size); }) == static_cast<ssize_t>(size);
    }

  private:
    std::array<int, 2> ends_ = {-1, -1};
};

struct Request {
    pid_t client = 0;
    int output = -1;
    std::function<int()> work;
};

/// In the child. That its parent ends must not end it, that its client does must. It begins when the client
/// knows of it: what no client knows of would be started again, beside it.
[[noreturn]] void be_child(const Request& request, pid_t between, Pipe& known) {
    known.close_end(1);
    while (getppid() == between)
        sched_yield();
    prctl(PR_SET_PDEATHSIG, SIGTERM);
    char none = 0;
    if (getppid() != request.client || !known.take(&none, 1)) ::kill(getpid(), SIGKILL);
    dup2(request.output, STDOUT_FILENO);
    dup2(request.output, STDERR_FILENO);
    std::exit(request.work());
}

/// Forks twice, so that the child becomes one of the client, which adopts it.
Answer fork_for(const Request& request, Pipe& known) {
    Pipe told;
    const pid_t between = fork();
    if (between == 0) {
        const pid_t self = getpid();
        const pid_t child = fork();
        if (child == 0) be_child(request, self, known);
        const Answer answer{.pid = child, .error = errno};
        _exit(told.give(&answer, sizeof answer) ? 0 : 1);
    }
    Answer answer{.error = errno};
    told.close_end(1);
    if (between > 0) {
        if (!told.take(&answer, sizeof answer)) answer = {.error = EIO};
        whole([&] { return waitpid(between, nullptr, 0); });
    }
    return answer;
}

}  // namespace

void serve_forks(int channel, pid_t client, const std::function<int(const std::string& word)>& work) {
    fcntl(channel, F_SETFD, FD_CLOEXEC);
    std::array<char, longest_request> bytes{};
    while (true) {
        const ssize_t size = whole([&] { return recv(channel, bytes.data(), bytes.size(), 0); });
        if (size <= 0) return;
        const std::string words(bytes.data(), static_cast<std::size_t>(size));
        const std::string path = words.substr(0, words.find('\0'));
        const int output = open(path.c_str(), O_CREAT | O_WRONLY | O_TRUNC | O_CLOEXEC, 0644);
        Answer answer{.error = errno, .is_of_output = true};
        Pipe known;
        if (output >= 0) {
            const auto its_work = [&] {
                close(channel);
                return work(words.substr(path.size() + 1));
            };
            answer = fork_for({client, output, its_work}, known);
            close(output);
        }
        if (whole([&] { return send(channel, &answer, sizeof answer, MSG_NOSIGNAL); }) < 0) return;
        if (answer.pid > 0) known.give("", 1);
    }
}

ForkServer::ForkServer(std::filesystem::path program, Machine& machine)
    : program_(std::move(program)), machine_(machine) {}

void ForkServer::start_server() {
    is_tried_ = true;
    std::array<int, 2> ends = {-1, -1};
    if (socketpair(AF_UNIX, SOCK_SEQPACKET | SOCK_CLOEXEC, 0, ends.data()) != 0) return;
    fcntl(ends[1], F_SETFD, 0);  // the server keeps it
    setsockopt(ends[0], SOL_SOCKET, SO_RCVTIMEO, &longest_answer, sizeof longest_answer);
    // What keeps it from serving is said by the command that is started instead.
    server_ = core::start({.program = program_,
                           .arguments = {serve_option, std::to_string(ends[1]), std::to_string(getpid())},
                           .output = "/dev/null"});
    channel_ = ends[0];
    close(ends[1]);
}

void ForkServer::end_server() {
    if (channel_ < 0) return;
    close(std::exchange(channel_, -1));
    ::kill(server_.pid, SIGKILL);  // it may hang; its children are ours
    whole([&] { return waitpid(server_.pid, nullptr, 0); });
}

Child ForkServer::start(const Command& command) {
    const bool is_served = command.program == program_ && command.arguments.size() == 1 &&
                           command.environment.empty() && command.folder.empty() && !command.output.empty();
    if (!is_served) return machine_.start(command);
    if (!is_tried_) start_server();
    if (channel_ < 0) return machine_.start(command);
    const std::string words = command.output.string() + '\0' + command.arguments.front();
    Answer answer;
    prctl(PR_SET_CHILD_SUBREAPER, 1);  // no longer than for this child: others' orphans would stay
    const bool is_answered =
        words.size() <= longest_request &&
        whole([&] { return send(channel_, words.data(), words.size(), MSG_NOSIGNAL); }) ==
            std::ssize(words) &&
        whole([&] { return recv(channel_, &answer, sizeof answer, 0); }) == sizeof answer;
    prctl(PR_SET_CHILD_SUBREAPER, 0);
    if (is_answered && answer.pid > 0) return {answer.pid, Clock::now()};
    if (is_answered && answer.is_of_output) throw write_error(command.output, answer.error);
    end_server();
    return machine_.start(command);
}

}  // namespace clearway::core
