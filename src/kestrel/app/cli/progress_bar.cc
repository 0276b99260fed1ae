// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/app/cli/progress_bar.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <string>
#include <unistd.h>

#include <fmt/format.h>

namespace kestrel {
namespace {

constexpr std::size_t kWidth = 40;
constexpr auto kPeriod = std::chrono::milliseconds(100);

std::string Line(std::size_t done, const std::optional<std::size_t>& total, double elapsed_s) {
  if (!total || *total == 0) return fmt::format("\r{} frames", done);
  const std::size_t filled = kWidth * std::min(done, *total) / *total;
  std::string line =
      fmt::format("\r[{:#<{}}{:<{}}] {}/{}", "", filled, "", kWidth - filled, done, *total);
  if (done > 0 && done < *total) {
    const auto left_s =
        std::lround(elapsed_s * static_cast<double>(*total - done) / static_cast<double>(done));
    line += fmt::format(", {}:{:02} left", left_s / 60, left_s % 60);
  }
  return line + "\033[K";
}

}  // namespace

ProgressBar::ProgressBar(std::optional<std::size_t> total)
    : is_terminal_(isatty(STDERR_FILENO) == 1),
      total_(total),
      started_(std::chrono::steady_clock::now()) {}

ProgressBar::~ProgressBar() { Clear(); }

void ProgressBar::Clear() const {
  if (is_terminal_) fmt::print(stderr, "\r\033[K");
}

void ProgressBar::Report(const std::string& line) const {
  Clear();
  fmt::print(stderr, "{}\n", line);
}

void ProgressBar::Show(std::size_t done) {
  const auto now = std::chrono::steady_clock::now();
  if (!is_terminal_ || now - last_shown_ < kPeriod) return;
  last_shown_ = now;
  const std::chrono::duration<double> elapsed = now - started_;
  fmt::print(stderr, "{}", Line(done, total_, elapsed.count()));
  std::fflush(stderr);
}

}  // namespace kestrel
