// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <atomic>
#include <functional>
#include <string>
#include <thread>
#include <variant>

#include "kestrel/foxglove/flight_writer.h"
#include "kestrel/foxglove/observation_file.h"

namespace kestrel {

// A flight as an MCAP file, written by a thread of its own: nobody waits for the disk, and frames
// that it does not keep up with are left out.
class FlightMcap : public FlightWriter {
 public:
  // What is told to the user: that the file cannot be written any more, and how many frames are
  // left out. Called by the thread that writes.
  using Tell = std::function<void(const std::string&)>;

  // As ObservationFile.
  FlightMcap(const std::string& path, bool replace, const CameraIntrinsics& camera,
             std::variant<LandingView, HuntView> view, Tell tell);
  // Writes all that it was given.
  ~FlightMcap() override;

 private:
  void Run();
  void WriteAll();

  ObservationFile file_;
  Tell tell_;
  std::atomic<bool> is_over_{false};
  std::thread thread_;
};

}  // namespace kestrel
