// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/comms/mavlink/timestamp_file.h"

#include <chrono>
#include <filesystem>
#include <optional>

#include <fmt/format.h>

#include "kestrel/core/base/error.h"
#include "kestrel/core/base/parse_number.h"
#include "kestrel/core/base/read_file.h"
#include "kestrel/core/base/write_file.h"

namespace kestrel {
namespace {

constexpr std::chrono::seconds kWriteEvery(30);
// A minute in ticks of 10 us: the largest loss from the file by a power cut.
constexpr std::uint64_t kMargin = 6'000'000;

std::uint64_t ReadStored(const std::string& path) {
  if (!std::filesystem::exists(path)) return 0;
  std::string text = ReadFile(path);
  while (!text.empty() && text.back() == '\n') text.pop_back();
  constexpr std::uint64_t kEnd = std::uint64_t{1} << 48;
  const auto timestamp = ParseNumber<std::uint64_t>(text);
  if (!timestamp || *timestamp >= kEnd) {
    throw InputError(
        fmt::format("{}: is no timestamp of signed packets, expected one number", path));
  }
  return *timestamp + kMargin;
}

}  // namespace

TimestampFile::TimestampFile(const std::string& path)
    : path_(path), stored_(ReadStored(path)), timestamp_(stored_) {
  Write(stored_);
  thread_ = std::thread(&TimestampFile::Run, this);
}

TimestampFile::~TimestampFile() {
  {
    const std::lock_guard lock(mutex_);
    is_ending_ = true;
  }
  wake_.notify_all();
  thread_.join();
}

void TimestampFile::Run() {
  std::unique_lock lock(mutex_);
  while (!is_ending_) {
    wake_.wait_for(lock, kWriteEvery, [&] { return is_ending_; });
    try {
      Write(timestamp_);
    } catch (const InputError&) {
      // The disk is full or gone: the next run begins by the clock. The recorder meets the same
      // error and reports it.
      continue;
    }
  }
}

void TimestampFile::Write(std::uint64_t timestamp) const {
  WriteFile(path_, fmt::format("{}\n", timestamp));
}

}  // namespace kestrel
