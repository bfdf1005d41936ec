#pragma once

#include <memory>
#include <string>
#include <string_view>

namespace clearway::trace::detail {

/// Hash of what was added, 32 hex digits; the same as core::content_hash of all of it.
class RunningHash {
  public:
    RunningHash();
    RunningHash(RunningHash&&) noexcept;
    ~RunningHash();

    void add(std::string_view bytes);
    std::string digest() const;

  private:
    struct State;
    std::unique_ptr<State> state_;
};

}  // namespace clearway::trace::detail
