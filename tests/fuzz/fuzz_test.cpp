// Whatever bytes a reader gets, it returns or refuses them: changed seeds, the same ones
// in each run.
#include <charconv>
#include <csignal>
#include <cstdlib>
#include <ctime>
#include <random>

#include <fmt/format.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include "core/error.hpp"
#include "core/files.hpp"
#include "fuzz/mutation.hpp"

namespace clearway::fuzz {
namespace {

/// Processor time that one input may take, s. Sanitizers need some of it.
constexpr double longest_s = 5.0;

std::string being_read;  ///< For the message of an input that ends the process.

void tell(int signal) {
    const std::string& text = being_read;
    static_cast<void>(::write(STDERR_FILENO, text.data(), text.size()));
    std::signal(signal, SIG_DFL);
    std::raise(signal);
}

unsigned asked_for(const char* variable, unsigned otherwise) {
    const char* const asked = std::getenv(variable);
    return asked == nullptr ? otherwise : static_cast<unsigned>(std::strtoul(asked, nullptr, 10));
}

double processor_s() {
    return static_cast<double>(std::clock()) / CLOCKS_PER_SEC;
}

class EveryReader : public testing::TestWithParam<Reader> {};

TEST_P(EveryReader, TakesItsSeeds) {
    for (const std::string& seed : GetParam().seeds)
        EXPECT_NO_THROW(GetParam().read(seed));
}

TEST_P(EveryReader, ReturnsOrRefuses) {
    const Reader& reader = GetParam();
    for (const int signal : {SIGSEGV, SIGABRT, SIGFPE, SIGILL, SIGBUS})
        std::signal(signal, tell);
    std::size_t refused = 0;
    const unsigned first = asked_for("CLEARWAY_FIRST_FUZZ_INPUT", 0);
    const unsigned inputs = asked_for("CLEARWAY_FUZZ_INPUTS", 10'000);
    const double first_s = processor_s();
    for (unsigned number = first; number < first + inputs; ++number) {
        std::mt19937_64 draw(number);
        const std::string bytes = changed_seed(reader, draw);
        being_read = fmt::format("the process ends at input {} of the reader {}\n", number, reader.name);
        const double begin_s = processor_s();
        try {
            reader.read(bytes);
        } catch (const core::Error& refusal) {
            ++refused;
            if (*refusal.what() == '\0') {
                core::write_atomically("refused_badly", bytes);
                FAIL() << being_read << "no message\nits bytes are in refused_badly";
            }
        } catch (const std::exception& error) {
            core::write_atomically("refused_badly", bytes);
            FAIL() << being_read << typeid(error).name() << ": " << error.what()
                   << "\nits bytes are in refused_badly";
        }
        ASSERT_LT(processor_s() - begin_s, longest_s) << "s for input " << number;
    }
    std::printf("%s: %u inputs, %zu refused, %.1f s\n", reader.name.c_str(), inputs, refused,
                processor_s() - first_s);
}

INSTANTIATE_TEST_SUITE_P(Readers, EveryReader, testing::ValuesIn(readers()),
                         [](const auto& reader) { return reader.param.name; });

}  // namespace
}  // namespace clearway::fuzz
