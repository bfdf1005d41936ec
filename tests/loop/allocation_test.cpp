#include <algorithm>
#include <array>
#include <cstdint>
#include <functional>
#include <map>
#include <ostream>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <gtest/gtest.h>
#include <link.h>
#include <unwind.h>

#include "loop/fixed_run.hpp"
#include "support/allocation_count.hpp"

namespace clearway {
namespace {

/// Where a file is loaded.
struct Range {
    std::uintptr_t begin = 0;
    std::uintptr_t end = 0;
    bool has(std::uintptr_t address) const { return begin <= address && address < end; }
};

/// Where allocations come from: Clearway's, which are those with no call of libsumo around them.
class Callers {
  public:
    Callers() { dl_iterate_phdr(&find_files, this); }

    /// Call in an allocation.
    void note() {
        Calls calls{*this};
        _Unwind_Backtrace(&follow, &calls);
        ++(calls.in_sumo ? sumo_ : clearway_[calls.innermost]);
    }
    std::uint64_t of_sumo() const { return sumo_; }
    std::uint64_t of_clearway() const {
        std::uint64_t sum = 0;
        for (const auto& [calls, count] : clearway_)
            sum += count;
        return sum;
    }
    /// The most frequent first.
    std::string places() const {
        std::vector<std::pair<std::uint64_t, Innermost>> sorted;
        for (const auto& [calls, count] : clearway_)
            sorted.emplace_back(count, calls);
        std::ranges::sort(sorted, std::greater<>());
        std::string text;
        for (const auto& [count, calls] : sorted) {
            text += fmt::format("{:6}  addr2line -Cfsp -e build/ci/tests/loop_allocation_test", count);
            for (const std::uintptr_t address : calls)
                if (address != 0) text += fmt::format(" {:#x}", address - 1 - program_file_.begin);
            text += '\n';
        }
        return text;
    }

  private:
    using Innermost = std::array<std::uintptr_t, 10>;  ///< Return addresses.
    struct Calls {
        const Callers& callers;
        Innermost innermost{};
        std::size_t count = 0;
        bool in_sumo = false;
    };

    static _Unwind_Reason_Code follow(_Unwind_Context* call, void* data) {
        Calls& calls = *static_cast<Calls*>(data);
        const std::uintptr_t address = _Unwind_GetIP(call);
        calls.in_sumo = calls.callers.sumo_file_.has(address);
        if (calls.callers.program_file_.has(address) && calls.count < calls.innermost.size())
            calls.innermost[calls.count++] = address;
        return calls.in_sumo ? _URC_END_OF_STACK : _URC_NO_REASON;
    }

    /// The program comes first and has no name.
    static int find_files(dl_phdr_info* file, std::size_t /*size*/, void* data) {
        Callers& callers = *static_cast<Callers*>(data);
        const bool is_program = callers.program_file_.end == 0;
        if (!is_program && std::string_view(file->dlpi_name).find("libsumocpp") == std::string_view::npos)
            return 0;
        Range& range = is_program ? callers.program_file_ : callers.sumo_file_;
        range.begin = file->dlpi_addr;
        for (const auto& segment : std::span(file->dlpi_phdr, file->dlpi_phnum))
            if (segment.p_type == PT_LOAD)
                range.end = std::max(range.end, file->dlpi_addr + segment.p_vaddr + segment.p_memsz);
        return 0;
    }

    Range program_file_;
    Range sumo_file_;
    std::uint64_t sumo_ = 0;
    std::map<Innermost, std::uint64_t> clearway_;
};

Callers* callers = nullptr;

struct Bound {
    const char* run;
    std::uint64_t most;
    friend void PrintTo(const Bound& bound, std::ostream* out) { *out << bound.run; }
};

/// What is left. Without policies a step allocates for vehicles that enter (their ids and routes), and where
/// tables grow with them. A decision of a policy, of which there are 20 in the city and 40 on the arterial,
/// also allocates
/// - lists of links: in stop lines, approaches, messages to signals, leases and what signals answer;
/// - lists of vehicles and lanes for one emergency vehicle (roads::WayAhead, LanePlan, Audience);
/// - states of signals that are held, which are strings, and clearance times when one is first held.
constexpr std::array bounds = {Bound{"intersection_baseline", 130}, Bound{"city_baseline", 150},
                               Bound{"city_corridor", 6400}, Bound{"city_corridor_repaired", 9700},
                               Bound{"arterial_linked", 3300}};

class Allocations : public testing::TestWithParam<Bound> {};

TEST_P(Allocations, AreNotMoreInTheMiddleOfARun) {
    const auto run = std::ranges::find_if(test::fixed_runs(), [](const test::FixedRun& one) {
        return std::string_view(one.name) == GetParam().run;
    });
    ASSERT_NE(run, test::fixed_runs().end());
    Callers found;
    callers = &found;
    test::in_the_middle_of(*run, [](loop::ClosedLoop& loop, core::Seconds end) {
        support::look_at_allocations([] { callers->note(); });
        loop.run(end);
        support::look_at_allocations(nullptr);
    });
    RecordProperty("allocations", std::to_string(found.of_clearway()));
    EXPECT_LE(found.of_clearway(), GetParam().most) << "from\n" << found.places();
    EXPECT_GT(found.of_sumo(), 0U) << "SUMO allocates, too";
}

INSTANTIATE_TEST_SUITE_P(FixedRuns, Allocations, testing::ValuesIn(bounds),
                         [](const auto& bound) { return std::string(bound.param.run); });

}  // namespace
}  // namespace clearway
