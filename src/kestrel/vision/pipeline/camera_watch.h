// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <chrono>
#include <cstddef>
#include <functional>
#include <optional>
#include <vector>

#include <opencv2/core.hpp>

#include "kestrel/core/base/time.h"
#include "kestrel/vision/pipeline/camera_sighting.h"
#include "kestrel/vision/pipeline/camera_state.h"
#include "kestrel/vision/pipeline/repeated_image.h"

namespace kestrel {

// Decides which of several cameras with one track can be used. A camera contradicts when several of
// its sightings in a row are outside of the track while those of another camera are inside, or when
// the mean of its latest sightings is turned against that of another camera: the mean shows a mount
// that is too little wrong for one sighting, and also where the track lies between the two. Of the
// two, the one is left out whose own views refute it, or that has moved the track before, or else
// the one that is outside; as long as they contradict each other, what refutes the one that is used
// exchanges them. A camera that is left out is used again when it has agreed for a while, and as
// long as no other camera sees the target.
class CameraWatch {
 public:
  // Whether the own views of 'camera' show that it is the one of the two that is wrong.
  using Refutes = std::function<bool(std::size_t camera, std::size_t other)>;

  explicit CameraWatch(std::size_t cameras) : cameras_(cameras) {}

  // Takes a frame; all times are on one clock. Does not allocate.
  void AddFrame(std::size_t camera, const cv::Mat& image, Time time);

  // Takes the place where the newest frame of 'camera' showed the target. True when a camera is
  // left out for it.
  bool AddSighting(std::size_t camera, const CameraSighting& sighting, const Refutes& refutes);

  // True when the newest frame of the camera can be used.
  bool IsUsed(std::size_t camera) const;
  // True when a sighting of the newest frame has a place by the track: IsUsed, or it is left out
  // for its sightings alone.
  bool IsJudged(std::size_t camera) const;
  // True when another camera that is used has seen the target within 'age' before 'time'.
  bool IsSeenByOthers(std::size_t camera, Time time, Duration age) const;
  const CameraState& state(std::size_t camera) const { return cameras_[camera].state; }

 private:
  static constexpr int kSightings = 10;  // in a row that contradict, or agree again
  static constexpr Duration kProbation = std::chrono::seconds(2);

  struct Watched {
    CameraState state;
    std::optional<Time> newest;
    std::optional<Time> seen;  // newest sighting while it was used
    RepeatedImage repeated;
    int outside = 0;                          // sightings in a row outside
    int confirmed_by_others = 0;              // sightings of others inside since the first of those
    std::array<CameraSighting, 32> latest{};  // ring
    std::size_t sightings = 0;                // since a track began or one was left out
    // While it contradicts: sightings in a row inside, and when they began.
    int agreements = 0;
    Time agrees_since;
    Duration probation = kProbation;  // so long they must go on; doubled each time
  };

  // Two cameras that are turned against each other.
  struct Turn {
    std::size_t farther;  // from the track
    std::size_t nearer;
    double offset_m;  // by which the two see the target apart
  };

  static void Set(Watched* camera, CameraHealth health, Time time);
  void UseThoseThatAreAlone(Time time);
  static bool CountOutside(Watched* camera);
  static double MedianOffset(const Watched& camera);  // of the latest kSightings
  bool Reconsider(std::size_t camera, const CameraSighting& sighting, const Refutes& refutes);
  void Confirm(std::size_t camera);
  static std::optional<CameraSighting> LatestMean(const Watched& camera, Time time);
  std::optional<Turn> TurnAgainstOthers(std::size_t camera, Time time) const;
  std::size_t Contradicting(std::size_t camera, std::size_t other, const Refutes& refutes) const;
  void LeaveOut(std::size_t camera, double offset_m, Time time);

  std::vector<Watched> cameras_;
  std::optional<Time> begin_;
  std::size_t confirmed_ = 0;  // camera of the newest sighting inside
  // Camera that moved the track while all others were used; nothing once another agreed.
  std::optional<std::size_t> moved_by_;
};

}  // namespace kestrel
