// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <functional>
#include <memory>
#include <mutex>
#include <utility>

#include "kestrel/flight/onboard/flight_recorder.h"

namespace kestrel {

// A recording that is switched on and off in flight. Any thread may call every function.
class RecordingSwitch {
 public:
  // Begins a recording in a folder; throws InputError as FlightRecorder does.
  using Open = std::function<std::unique_ptr<FlightRecorder>(const std::filesystem::path& folder,
                                                             bool replace)>;

  explicit RecordingSwitch(Open open) : open_(std::move(open)) {}
  ~RecordingSwitch() { Close(); }
  RecordingSwitch(const RecordingSwitch&) = delete;
  RecordingSwitch& operator=(const RecordingSwitch&) = delete;

  // Returns the running recording, to be held only while data are given to it; null: none. Does not
  // wait for anybody who waits for a disk.
  std::shared_ptr<FlightRecorder> Get() const;

  // Returns false, and does nothing, while a recording runs or after Close. Throws InputError as
  // 'open' does.
  bool Start(const std::filesystem::path& folder, bool replace);
  // Returns when all data of the recording are written; false: none was running.
  bool Stop();
  // The same, and nothing can be started afterwards.
  void Close();

 private:
  Open open_;
  std::mutex switching_;  // held during Start, Stop and Close
  bool is_closed_ = false;
  mutable std::mutex mutex_;  // guards what is below, while a pointer is copied
  std::shared_ptr<FlightRecorder> recorder_;
};

}  // namespace kestrel
