#pragma once

#include <filesystem>
#include <functional>
#include <type_traits>

namespace clearway::loop {

namespace detail {
/// Runs `drive` in a copy, which then sends these bytes; here they are replaced by what came.
void in_copy(const std::filesystem::path& folder, const std::function<void()>& drive, void* answer,
             std::size_t size);
}  // namespace detail

/// What `drive` finds in a forked copy of the whole run, which ends with it: the run itself does not notice.
/// The copy writes into `folder`, which is made and removed. Throws core::EnvironmentError when no copy can
/// be made, core::SimulatorError when it does not come to its end; its own words go to standard error.
template <class Drive>
auto in_copy(const std::filesystem::path& folder, const Drive& drive) {
    std::invoke_result_t<Drive> answer{};
    static_assert(std::is_trivially_copyable_v<decltype(answer)>, "it is sent as bytes");
    detail::in_copy(
        folder, [&] { answer = drive(); }, &answer, sizeof answer);
    return answer;
}

}  // namespace clearway::loop
