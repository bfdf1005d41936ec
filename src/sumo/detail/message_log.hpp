#pragma once

#include <deque>
#include <filesystem>
#include <iosfwd>
#include <streambuf>
#include <string>

namespace clearway::sumo::detail {

/// Receives what SUMO prints: every message goes to a file at once, so that the file is complete even when
/// SUMO aborts; the last lines are kept for error messages.
///
/// SUMO's own `--log` was rejected: it is buffered, so its end is missing just when it is needed, and it
/// contains wall times, so equal runs would differ.
class MessageLog : public std::streambuf {
  public:
    /// Creates or truncates `file`. Throws core::EnvironmentError when that fails.
    explicit MessageLog(const std::filesystem::path& file);
    ~MessageLog() override;
    MessageLog(const MessageLog&) = delete;
    MessageLog& operator=(const MessageLog&) = delete;

    /// The last lines (at most 12), with line ends; empty when SUMO said nothing.
    std::string last_lines() const;

  protected:
    int_type overflow(int_type letter) override;
    std::streamsize xsputn(const char* text, std::streamsize count) override;

  private:
    int descriptor_;
    std::string line_;
    std::deque<std::string> last_lines_;
};

/// During its lifetime, everything that is written to std::cerr (SUMO's channel for warnings and errors in
/// this process) goes to the log.
class MessageCapture {
  public:
    explicit MessageCapture(MessageLog& log);
    ~MessageCapture();
    MessageCapture(const MessageCapture&) = delete;
    MessageCapture& operator=(const MessageCapture&) = delete;

  private:
    std::streambuf* former_;
};

}  // namespace clearway::sumo::detail
