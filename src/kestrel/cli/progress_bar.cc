// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/cli/progress_bar.h"

#include <algorithm>
#include <cstdio>
#include <string>
#include <unistd.h>

#include <fmt/format.h>

namespace kestrel {
namespace {

constexpr std::size_t kWidth = 40;
constexpr auto kPeriod = std::chrono::milliseconds(100);

std::string Line(std::size_t done, const std::optional<std::size_t>& total) {
  if (!total || *total == 0) return fmt::format("\r{} frames", done);
  const std::size_t filled = kWidth * std::min(done, *total) / *total;
  return fmt::format("\r[{:#<{}}{:<{}}] {}/{}", "", filled, "", kWidth - filled, done, *total);
}

}  // namespace

ProgressBar::ProgressBar(std::optional<std::size_t> total)
    : is_terminal_(isatty(STDERR_FILENO) == 1), total_(total) {}

ProgressBar::~ProgressBar() {
  if (is_terminal_) fmt::print(stderr, "\r\033[K");
}

void ProgressBar::Show(std::size_t done) {
  const auto now = std::chrono::steady_clock::now();
  if (!is_terminal_ || now - last_shown_ < kPeriod) return;
  last_shown_ = now;
  fmt::print(stderr, "{}", Line(done, total_));
  std::fflush(stderr);
}

}  // namespace kestrel
