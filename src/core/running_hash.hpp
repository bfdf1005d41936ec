#pragma once

#include <memory>
#include <string>
#include <string_view>

namespace clearway::core {

/// Hash of everything added, 32 hex digits (XXH3, 128 bit): equal to `content_hash` of the whole.
class RunningHash {
  public:
    RunningHash();
    RunningHash(RunningHash&&) noexcept;
    RunningHash& operator=(RunningHash&&) noexcept;
    ~RunningHash();

    void add(std::string_view bytes);
    std::string digest() const;

  private:
    struct State;
    std::unique_ptr<State> state_;
};

}  // namespace clearway::core
