// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <atomic>
#include <memory>
#include <mutex>
#include <optional>
#include <string>

#include "kestrel/core/base/limits.h"
#include "kestrel/core/camera/camera_model.h"
#include "kestrel/flight/onboard/exposure_actuator.h"
#include "kestrel/flight/onboard/sender_clock.h"
#include "kestrel/flight/session/live_source.h"
#include "kestrel/io/recording/frame.h"

namespace kestrel {

class GstreamerPipeline;
class ImagePool;

struct GstreamerCameraOptions {
  double readout_s = 0;
  double exposure_s = 0;
  std::string exposure_property = {};
  double exposure_unit_s = 1e-6;
  std::string device_caps = {};
  double stall_s = 2;
  bool measures_delay = false;
  double reopen_s = 0.5;  // first interval between attempts to open a lost camera; it doubles

  static void Visit(auto& self, auto&& visit) {
    visit("readout_s", self.readout_s, Range{-1, 1},
          "time from the end of the exposure to the driver's time stamp");
    visit(
        "exposure_s", self.exposure_s, Range{0, 1},
        "length of the exposure, as long as it is not controlled; 0: the driver stamps its middle");
    visit("exposure_property", self.exposure_property,
          "GStreamer's element.property that sets the exposure; empty: the control of V4L2");
    visit("exposure_unit_s", self.exposure_unit_s, MoreThan(0), "unit of exposure_property");
    visit("device_caps", self.device_caps,
          "caps that are requested of /dev/videoN; empty: raw images of the calibration's size");
    visit("stall_s", self.stall_s, Range{0.1, 3600},
          "time without a frame after which the camera is lost");
    visit(
        "measures_delay", self.measures_delay,
        "the clock offset is measured in flight by the turns of the images, also of a camera with "
        "one in its file; always done for a network's camera without");
    visit.Gone({"reopen_s", "max_reopen_s"});
  }
};

// A camera through GStreamer: a device (/dev/video0), an address (rtsp://...), or any pipeline.
// Only the newest frame is kept. A frame's time is its buffer's PTS on the pipeline's clock, which
// is that of Now(), minus half of the exposure and the read-out. The times of a network's frames
// have the intervals of the sender's clock and are late by the shortest way of a frame, see
// SenderClock and LateVideo; its smeared frames, and those of another size, are left out.
class GstreamerCamera : public LiveSource, public ExposureActuator {
 public:
  // 'camera': "/dev/video0", "rtsp://..." or a pipeline ("videotestsrc is-live=true ! ..."), with
  // or without an appsink at its end. 'calibration': of width 0 where the camera has none; frames
  // of any size are then given out. Waits for the first frame, up to 10 s. Throws InputError with
  // one line: no such device, a pipeline that does not parse or start, frames of another size than
  // the calibration's, options that are not valid.
  GstreamerCamera(const std::string& camera, const CameraIntrinsics& calibration,
                  PixelFormat format, const GstreamerCameraOptions& options);
  ~GstreamerCamera() override;

  std::optional<Event> Next(Duration timeout) override;
  std::string error() const override;
  CaptureCounters counters() const override;

  // Called by any thread. The times of the frames follow the new exposure.
  bool SetExposure(double exposure_s) override;

 private:
  // These throw InputError with a message for the user.
  void Open();
  void StartPipeline(GstreamerPipeline* pipeline) const;
  std::optional<Event> TakeFrame(Duration timeout);
  bool IsUsable(int width_px, int height_px, bool is_smeared);
  Time NetworkTime(Time stamp, std::optional<Time> sent, Time now);

  std::optional<Event> TakeFrameOrFail(Duration timeout);
  void Fail(const std::string& reason);
  bool Reopen();
  Time CaptureTime(std::optional<Time> driver_time, Time now);

  std::string camera_;
  std::string name_;  // of the camera, for messages: without a password
  bool is_network_;
  CameraIntrinsics calibration_;
  PixelFormat format_;
  GstreamerCameraOptions options_;
  std::unique_ptr<ExposureActuator> v4l2_exposure_;  // null: the camera is no device
  std::atomic<double> exposure_s_;
  std::unique_ptr<ImagePool> images_;
  std::optional<Event> first_;  // the frame that the constructor has waited for
  Time last_time_ = Time::min();
  Time last_arrival_;
  SenderClock stream_clock_, sender_clock_;  // of a network's frames, by RTP and by RTCP
  Time next_attempt_;                        // of reopening
  Duration back_off_{};
  bool has_ended_ = false;

  mutable std::mutex mutex_;  // guards what follows
  // Only Next replaces it; Next may use it without the lock.
  std::unique_ptr<GstreamerPipeline> pipeline_;
  CaptureCounters counters_;
  std::string error_;
};

}  // namespace kestrel
