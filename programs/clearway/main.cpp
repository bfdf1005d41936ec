#include "cli/verb.hpp"

int main(int argument_count, char** arguments) {
    return clearway::cli::run_command_line(argument_count, arguments);
}
