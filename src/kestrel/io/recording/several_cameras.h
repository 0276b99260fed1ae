// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <memory>
#include <optional>
#include <vector>

#include "kestrel/core/base/time.h"
#include "kestrel/io/recording/frame_source.h"

namespace kestrel {

// The cameras of one UAV as one source. Frames are in order of time on the clock of the navigation,
// each with the index of its camera and the time of its camera's own clock. Everything else is as
// of the first camera.
class SeveralCameras : public FrameSource {
 public:
  struct Camera {
    std::unique_ptr<FrameSource> source;
    Duration clock_offset{};  // t_nav = t_image + clock_offset
  };
  // 'cameras': at least one.
  explicit SeveralCameras(std::vector<Camera> cameras);
  SeveralCameras(const SeveralCameras&) = delete;  // the sources refer to it
  SeveralCameras& operator=(const SeveralCameras&) = delete;

  std::optional<std::size_t> frame_count() const override;
  double rate_hz() const override { return first().rate_hz(); }
  double camera_rate_hz(std::size_t camera) const override {
    return queues_[camera].source->rate_hz();
  }
  std::optional<CameraCalibration> calibration() const override { return first().calibration(); }
  CameraMount mount() const override { return first().mount(); }
  std::vector<PoseSample> poses() const override { return first().poses(); }
  std::vector<GimbalSample> gimbal() const override { return first().gimbal(); }
  std::vector<ZoomSample> zoom() const override { return first().zoom(); }

 private:
  struct Queue {
    std::unique_ptr<FrameSource> source;
    Duration clock_offset{};
    std::optional<Frame> next = {};
    bool has_ended = false;
  };

  bool ReadNext(Frame* frame) override;
  void Fill(std::size_t camera);
  const FrameSource& first() const { return *queues_.front().source; }

  std::vector<Queue> queues_;
  std::vector<BrokenImage> broken_;  // met while looking ahead
};

}  // namespace kestrel
