// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <functional>
#include <string>
#include <utility>

#include <opencv2/core.hpp>

#include "kestrel/core/base/time.h"
#include "kestrel/flight/onboard/recording_switch.h"

namespace kestrel {

// Returns a path in 'folder' that does not exist yet: 'prefix', and the time of day (UTC).
std::filesystem::path PathOfNow(const std::filesystem::path& folder,
                                const std::string& prefix = "");

// Keeps recordings and snapshots that the user requests in flight, in a folder of its own. Never
// replaces existing files. Used by one thread, which waits for the disk.
class FlightKeeper {
 public:
  // 'folder' is made when there is something to keep. 'recording' outlives the keeper.
  FlightKeeper(std::filesystem::path folder, RecordingSwitch* recording)
      : folder_(std::move(folder)), recording_(recording) {}

  // Each returns the outcome in a line for the user, and throws InputError on failure. The name of
  // a new recording is the time of day (UTC).
  std::string StartRecording();
  std::string StopRecording();
  // Stores the unchanged image, with the time of its capture in its name.
  std::string KeepSnapshot(const cv::Mat& image, Time captured);

 private:
  void MakeFolder() const;

  std::filesystem::path folder_;
  RecordingSwitch* recording_;
};

}  // namespace kestrel
