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

// A path in 'folder' of which there is nothing yet: 'prefix', and the time of day (UTC).
std::filesystem::path PathOfNow(const std::filesystem::path& folder,
                                const std::string& prefix = "");

// What a user asks to be kept while the UAV flies, in a folder of its own: nothing that is there
// is replaced. By one thread, which waits for the disk.
class FlightKeeper {
 public:
  // 'folder' is made when something is to be kept. 'recording' outlives the keeper.
  FlightKeeper(std::filesystem::path folder, RecordingSwitch* recording)
      : folder_(std::move(folder)), recording_(recording) {}

  // Each says what became of it, in a line for the user; throws InputError when that cannot be
  // done. A new recording has the time of day (UTC) as its name.
  std::string StartRecording();
  std::string StopRecording();
  // The image as it is, with the time of its capture in its name.
  std::string KeepSnapshot(const cv::Mat& image, Time captured);

 private:
  void MakeFolder() const;

  std::filesystem::path folder_;
  RecordingSwitch* recording_;
};

}  // namespace kestrel
