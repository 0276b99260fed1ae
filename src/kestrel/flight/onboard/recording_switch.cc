// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/flight/onboard/recording_switch.h"

#include <chrono>
#include <thread>
#include <utility>

namespace kestrel {

std::shared_ptr<FlightRecorder> RecordingSwitch::Get() const {
  const std::lock_guard lock(mutex_);
  return recorder_;
}

bool RecordingSwitch::Start(const std::filesystem::path& folder, bool replace) {
  const std::lock_guard switching(switching_);
  if (is_closed_ || Get()) return false;
  std::shared_ptr<FlightRecorder> recorder = open_(folder, replace);
  const std::lock_guard lock(mutex_);
  recorder_ = std::move(recorder);
  return true;
}

bool RecordingSwitch::Stop() {
  const std::lock_guard switching(switching_);
  std::shared_ptr<FlightRecorder> recorder;
  {
    const std::lock_guard lock(mutex_);
    recorder = std::exchange(recorder_, nullptr);
  }
  if (!recorder) return false;
  // The recorder's end waits for the disk: that happens here, not in a thread that still gives it
  // data.
  while (recorder.use_count() > 1) std::this_thread::sleep_for(std::chrono::milliseconds(1));
  return true;
}

void RecordingSwitch::Close() {
  {
    const std::lock_guard switching(switching_);
    is_closed_ = true;
  }
  Stop();
}

}  // namespace kestrel
