// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <atomic>
#include <cstdint>
#include <optional>
#include <string>
#include <thread>

#include "kestrel/base/time.h"
#include "kestrel/camera/calibration.h"
#include "kestrel/middleware/landing_results.h"
#include "kestrel/onboard/bounded_queue.h"
#include "kestrel/onboard/latency_statistics.h"
#include "kestrel/onboard/live_events.h"
#include "kestrel/pipeline/landing_pipeline.h"
#include "kestrel/recording/frame.h"
#include "kestrel/ros/node_connection.h"
#include "kestrel/ros/node_options.h"

namespace kestrel {

// The landing pipeline of the node, with a thread of its own, from the first image to a reset.
class LandingFlight {
 public:
  struct Frames {
    std::string camera;
    std::optional<std::string> world;  // where there are poses
  };

  // Throws InputError when calibration or options are not valid.
  LandingFlight(const CameraCalibration& calibration, const NodeOptions& options,
                const Frames& frames, NodeConnection* connection);
  ~LandingFlight();

  // Neither waits. 'arrival', by Now(): from when the latency counts.
  void Push(Frame frame, Time arrival);
  void Push(const PoseSample& pose) { events_.Push(pose); }

  const CameraIntrinsics& intrinsics() const { return pipeline_.detector().camera().intrinsics(); }

  struct Counters {
    LiveEvents::Counters events;
    std::uint64_t detections = 0;
    LatencySummary latency;        // from an image's arrival until its detection was published
    LatencySummary beyond_detect;  // the same without the time of Detect
    LatencySummary detect;
  };
  Counters counters() const;

 private:
  struct Arrival {
    Time stamp;
    Time arrival;
  };

  void Run();
  void Process(const Frame& frame);
  void CountLatency(const LandingObservation& observation);
  NodeOptions options_;
  NodeConnection* connection_;
  LandingPipeline pipeline_;
  LiveEvents events_;
  LandingResults results_;
  BoundedQueue<Arrival> arrivals_;
  std::atomic<std::uint64_t> detections_ = 0;
  LatencyHistogram latency_, beyond_detect_, detect_;
  std::thread thread_;
};

}  // namespace kestrel
