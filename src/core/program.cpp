#include "core/program.hpp"

#include <cstdio>
#include <new>
#include <system_error>

#include "core/machine_failure.hpp"
#include "core/read_failure.hpp"

namespace clearway::core {
namespace {

ExitCode end_with(const std::string& name, const std::exception& error, ExitCode code) {
    std::fflush(stdout);
    complain(name, error);
    return code;
}

EnvironmentError no_output() {
    return EnvironmentError(
        "standard output cannot be written. Check where it goes and give the same command again");
}

}  // namespace

void complain(const std::string& name, const std::exception& error) {
    for (const char* const part : {name.c_str(), ": ", error.what(), "\n"})
        std::fputs(part, stderr);
}

ExitCode end_of(const std::string& name, const std::function<ExitCode()>& act, ExitCode of_bug) {
    try {
        const ExitCode code = act();
        if (std::fflush(stdout) != 0 || std::ferror(stdout) != 0) throw no_output();
        return code;
    } catch (const std::system_error& error) {
        if (std::ferror(stdout) != 0) return end_with(name, no_output(), ExitCode::environment);
        const Error told = error_of(error);
        return end_with(name, told, told.exit_code());
    } catch (const Error& error) {
        return end_with(name, error, error.exit_code());
    } catch (const std::bad_alloc&) {
        return end_with(name, no_memory(), ExitCode::environment);
    } catch (const std::exception& error) {
        return end_with(name, error, of_bug);
    }
}

}  // namespace clearway::core
