#include <cstdlib>

#include "cli/verb.hpp"
#include "core/process.hpp"

int main(int argument_count, char** arguments) {
    clearway::core::begin_program();
    constexpr int keep_the_users = 0;
    ::setenv("SUMO_HOME", "/usr/share/sumo", keep_the_users);
    return clearway::cli::run_command_line(argument_count, arguments);
}
