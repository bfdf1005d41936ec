// A program for the tests of the fork server. It notes its process in the file LOADS, and does what its word
// says: `code N`, `signal N`, `sleep`, leave an `orphan` and say its process; or it says the word and its
// parent.

#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <string>

#include <unistd.h>

#include "core/fork_server.hpp"

namespace {

int work(const std::string& word) {
    if (word.starts_with("code ")) return std::atoi(word.c_str() + 5);
    if (word.starts_with("signal ")) std::raise(std::atoi(word.c_str() + 7));
    if (word == "sleep") sleep(60);
    if (word == "orphan") {
        const pid_t orphan = fork();
        if (orphan == 0) {
            sleep(60);
            _exit(0);
        }
        std::printf("%d\n", orphan);
        return 0;
    }
    std::printf("%s of %d\n", word.c_str(), getppid());
    return 0;
}

}  // namespace

int main(int argument_count, char** arguments) {
    if (const char* const loads = std::getenv("LOADS")) {
        std::FILE* const file = std::fopen(loads, "a");
        std::fprintf(file, "%d\n", getpid());
        std::fclose(file);
    }
    if (argument_count == 2) return work(arguments[1]);
    clearway::core::serve_forks(std::atoi(arguments[2]), std::atoi(arguments[3]), work);
    return 0;
}
