#include "core/process.hpp"

#include <algorithm>
#include <array>
#include <cctype>
#include <cerrno>
#include <csignal>
#include <cstdlib>
#include <cstring>
#include <deque>
#include <fstream>
#include <string_view>
#include <utility>

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include "core/atomic_file.hpp"
#include "core/error.hpp"

extern char** environ;

namespace clearway::core {
namespace {

std::vector<std::string> merged_environment(const std::map<std::string, std::string>& extra) {
    std::vector<std::string> entries;
    for (char** entry = environ; *entry != nullptr; ++entry) {
        const std::string text = *entry;
        if (!extra.contains(text.substr(0, text.find('=')))) entries.push_back(text);
    }
    for (const auto& [name, value] : extra) {
        entries.push_back(name + "=" + value);
    }
    return entries;
}

std::vector<char*> pointers(std::vector<std::string>& texts) {
    std::vector<char*> result;
    result.reserve(texts.size() + 1);
    for (std::string& text : texts) {
        result.push_back(text.data());
    }
    result.push_back(nullptr);
    return result;
}

double seconds(const timeval& time) {
    return static_cast<double>(time.tv_sec) + 1e-6 * static_cast<double>(time.tv_usec);
}

std::optional<Exit> collect(const Child& child, int options) {
    int status = 0;
    rusage usage{};
    pid_t ended = 0;
    while ((ended = wait4(child.pid, &status, options, &usage)) < 0) {
        if (errno != EINTR) {
            throw EnvironmentError(
                fmt::format("waiting for process {}: {}", child.pid, std::strerror(errno)));
        }
    }
    if (ended == 0) return std::nullopt;
    Exit exit;
    exit.wall_s = std::chrono::duration<double>(std::chrono::steady_clock::now() - child.started).count();
    exit.cpu_s = seconds(usage.ru_utime) + seconds(usage.ru_stime);
    exit.peak_kib = usage.ru_maxrss;
    if (WIFSIGNALED(status)) exit.signal = WTERMSIG(status);
    if (WIFEXITED(status)) exit.code = WEXITSTATUS(status);
    return exit;
}

/// A word quoted for a shell.
std::string quoted(const std::string& word) {
    const auto plain = [](unsigned char letter) {
        return std::isalnum(letter) != 0 ||
               std::string_view("-_./=,:+@%").find(static_cast<char>(letter)) != std::string_view::npos;
    };
    if (!word.empty() && std::ranges::all_of(word, plain)) return word;
    std::string text = "'";
    for (const char letter : word) {
        text += letter == '\'' ? std::string("'\\''") : std::string(1, letter);
    }
    return text + "'";
}

/// In the child: `stream` is `output` from now on, also in the program that the child becomes.
void take_over(int output, int stream) {
    if (output == stream) {
        fcntl(stream, F_SETFD, 0);  // dup2 would do nothing, and the descriptor would be closed
    } else {
        dup2(output, stream);
    }
}

/// Returns when the child has become its program, or has ended: `open_until_then` is closed by either.
void await_program(int open_until_then) {
    char none = 0;
    while (read(open_until_then, &none, 1) < 0 && errno == EINTR) {
    }
    close(open_until_then);
}

[[noreturn]] void become(const Command& command, int output, pid_t parent, char** arguments,
                         char** environment) {
    // Only calls which are safe after a fork in a program with threads are allowed here.
    prctl(PR_SET_PDEATHSIG, SIGTERM);
    if (getppid() != parent) _exit(128 + SIGTERM);  // The parent died before prctl took effect.
    if (output >= 0) {
        take_over(output, STDOUT_FILENO);
        take_over(output, STDERR_FILENO);
    }
    if (!command.folder.empty() && chdir(command.folder.c_str()) != 0) _exit(127);
    execvpe(command.program.c_str(), arguments, environment);
    _exit(127);
}

}  // namespace

std::string Exit::describe() const {
    if (signal != 0) return fmt::format("killed by signal {} ({})", signal, strsignal(signal));
    return fmt::format("exit code {}", code);
}

Child start(const Command& command) {
    int output = -1;
    if (!command.output.empty()) {
        output = open(command.output.c_str(), O_CREAT | O_WRONLY | O_TRUNC | O_CLOEXEC, 0644);
        if (output < 0) {
            throw write_error(command.output, errno);
        }
    }
    std::vector<std::string> words = {command.program.string()};
    words.insert(words.end(), command.arguments.begin(), command.arguments.end());
    std::vector<std::string> entries = merged_environment(command.environment);
    const std::vector<char*> arguments = pointers(words);
    const std::vector<char*> environment = pointers(entries);

    std::array<int, 2> waiting = {-1, -1};
    const pid_t parent = getpid();
    const pid_t child = pipe2(waiting.data(), O_CLOEXEC) == 0 ? fork() : -1;
    if (child == 0) {
        become(command, output, parent, const_cast<char**>(arguments.data()),
               const_cast<char**>(environment.data()));
    }
    const int failure = errno;
    if (output >= 0) close(output);
    if (waiting[1] >= 0) close(waiting[1]);
    if (child < 0) {
        if (waiting[0] >= 0) close(waiting[0]);
        throw EnvironmentError(
            fmt::format("cannot start {}: {}. The machine failed: give the same command again", words[0],
                        std::strerror(failure)));
    }
    await_program(waiting[0]);
    return {child, std::chrono::steady_clock::now()};
}

Exit wait(const Child& child) {
    return *collect(child, 0);
}

std::optional<Exit> poll(const Child& child) {
    return collect(child, WNOHANG);
}

std::optional<long> resident_kib(pid_t process) {
    std::ifstream stream(fmt::format("/proc/{}/statm", process));
    long size = 0;
    long resident = 0;
    if (!(stream >> size >> resident)) return std::nullopt;
    return resident * (::sysconf(_SC_PAGESIZE) / 1024);
}

Exit run(const Command& command) {
    return wait(start(command));
}

void open_standard_streams() {
    for (const auto& [stream, access] :
         {std::pair{STDIN_FILENO, O_RDONLY}, std::pair{STDOUT_FILENO, O_RDONLY},
          std::pair{STDERR_FILENO, O_WRONLY}}) {
        if (fcntl(stream, F_GETFD) < 0) open("/dev/null", access);  // takes the lowest number that is free
    }
}

void begin_program() {
    open_standard_streams();
    std::signal(SIGXFSZ, SIG_IGN);
    constexpr rlim_t usual = 8U << 20U;
    constexpr rlim_t least = 1U << 20U;
    rlimit stack{};
    if (getrlimit(RLIMIT_STACK, &stack) != 0 || stack.rlim_cur >= usual) return;
    stack.rlim_cur = std::min(usual, stack.rlim_max);
    setrlimit(RLIMIT_STACK, &stack);
    if (stack.rlim_cur >= least) return;
    fmt::print(
        stderr,
        "{}: the stack is limited to {} KiB (allowed: 1024 or more). Raise the limit: ulimit -s 8192\n",
        program_invocation_short_name, stack.rlim_cur / 1024);
    std::exit(static_cast<int>(ExitCode::environment));
}

std::string shell_text(const std::vector<std::string>& words) {
    std::string text;
    for (const std::string& word : words)
        text += (text.empty() ? "" : " ") + quoted(word);
    return text;
}

std::vector<std::string> with_option(std::vector<std::string> words, const std::string& name,
                                     const std::string& value) {
    const auto found = std::ranges::find_if(
        words, [&](const std::string& word) { return word == name || word.starts_with(name + "="); });
    if (found == words.end()) {
        words.insert(words.end(), {name, value});
    } else if (*found != name) {
        *found = name + "=" + value;
    } else if (found + 1 != words.end()) {
        found[1] = value;
    }
    return words;
}

std::string tail(const std::filesystem::path& file, int lines) {
    std::ifstream stream(file);
    std::deque<std::string> kept;
    for (std::string line; std::getline(stream, line);) {
        kept.push_back(line);
        if (std::ssize(kept) > lines) kept.pop_front();
    }
    std::string text;
    for (const std::string& line : kept) {
        text += line + "\n";
    }
    return text;
}

std::filesystem::path program_folder() {
    std::error_code error;
    const std::filesystem::path program = std::filesystem::read_symlink("/proc/self/exe", error);
    if (error)
        throw EnvironmentError(
            fmt::format("/proc/self/exe cannot be read: {}. Mount /proc: programs and limits "
                        "of memory are found there",
                        error.message()));
    return program.parent_path();
}

}  // namespace clearway::core
