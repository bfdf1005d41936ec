#include <csignal>
#include <cstdlib>

#include "cli/verb.hpp"
#include "core/process.hpp"

int main(int argument_count, char** arguments) {
    clearway::core::open_standard_streams();
    std::signal(SIGXFSZ, SIG_IGN);  // a file over `ulimit -f` is then an error that names it
    constexpr int keep_the_users = 0;
    ::setenv("SUMO_HOME", "/usr/share/sumo", keep_the_users);
    return clearway::cli::run_command_line(argument_count, arguments);
}
