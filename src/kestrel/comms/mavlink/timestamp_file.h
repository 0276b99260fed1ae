// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <atomic>
#include <condition_variable>
#include <cstdint>
#include <mutex>
#include <string>
#include <thread>

namespace kestrel {

// Keeps the latest timestamp of signed packets on disk from one run to the next. A thread of its
// own writes it, because a disk may be slow.
class TimestampFile {
 public:
  // Throws InputError when the file exists and holds no timestamp, or cannot be written.
  explicit TimestampFile(const std::string& path);
  ~TimestampFile();
  TimestampFile(const TimestampFile&) = delete;
  TimestampFile& operator=(const TimestampFile&) = delete;

  // Timestamp of the previous run; 0 where there was none. It is ahead of the one in the file by as
  // much as may have been used after the last write.
  std::uint64_t stored() const { return stored_; }

  // Called by any thread; does not wait.
  void Set(std::uint64_t timestamp) { timestamp_ = timestamp; }

 private:
  void Run();
  void Write(std::uint64_t timestamp) const;

  std::string path_;
  std::uint64_t stored_ = 0;
  std::atomic<std::uint64_t> timestamp_ = 0;
  std::mutex mutex_;
  std::condition_variable wake_;
  bool is_ending_ = false;
  std::thread thread_;
};

}  // namespace kestrel
