// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <chrono>
#include <cstddef>
#include <optional>
#include <string>

namespace kestrel {

// A line on stderr with the progress of a run and the remaining time; nothing when stderr is not a
// terminal.
class ProgressBar {
 public:
  explicit ProgressBar(std::optional<std::size_t> total);
  ~ProgressBar();  // removes the line
  ProgressBar(const ProgressBar&) = delete;
  ProgressBar& operator=(const ProgressBar&) = delete;

  void Show(std::size_t done);

  // Prints a line on stderr, terminal or not, above the bar.
  void Report(const std::string& line) const;

 private:
  void Clear() const;

  bool is_terminal_;
  std::optional<std::size_t> total_;
  std::chrono::steady_clock::time_point started_;
  std::chrono::steady_clock::time_point last_shown_;
};

}  // namespace kestrel
