// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <functional>
#include <memory>
#include <mutex>
#include <utility>

#include "kestrel/flight/onboard/flight_recorder.h"

namespace kestrel {

// A recording that is switched on and off in flight. Every function may be called by any thread.
class RecordingSwitch {
 public:
  // Begins a recording in a folder; throws InputError as FlightRecorder does.
  using Open = std::function<std::unique_ptr<FlightRecorder>(const std::filesystem::path& folder,
                                                             bool replace)>;

  explicit RecordingSwitch(Open open) : open_(std::move(open)) {}
  ~RecordingSwitch() { Close(); }
  RecordingSwitch(const RecordingSwitch&) = delete;
  RecordingSwitch& operator=(const RecordingSwitch&) = delete;

  // The recording that is on, for as long as something is given to it; null: none. Waits for
  // nobody who waits for a disk.
  std::shared_ptr<FlightRecorder> Get() const;

  // False, and nothing is done, while one is on, or after Close. Throws InputError as 'open' does.
  bool Start(const std::filesystem::path& folder, bool replace);
  // Returns when all that the recording was given is written; false: none is on.
  bool Stop();
  // The same, for good.
  void Close();

 private:
  Open open_;
  std::mutex switching_;  // one after the other
  bool is_closed_ = false;
  mutable std::mutex mutex_;  // of what is below, for as long as a pointer is copied
  std::shared_ptr<FlightRecorder> recorder_;
};

}  // namespace kestrel
