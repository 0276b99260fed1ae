// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <functional>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "kestrel/core/base/error.h"
#include "kestrel/core/base/time.h"
#include "kestrel/core/camera/calibration.h"
#include "kestrel/core/geometry/rigid_transform.h"
#include "kestrel/core/poses/gimbal_history.h"
#include "kestrel/core/poses/pose_history.h"
#include "kestrel/core/poses/zoom_history.h"
#include "kestrel/io/recording/frame.h"

namespace kestrel {

// Frames per second of sources without a rate, such as image files.
inline constexpr double kNominalRateHz = 30;

// The mount of a camera, as far as it is known.
struct CameraMount {
  std::optional<RigidTransform> body_from_camera;
  std::optional<Duration> clock_offset;  // t_nav = t_image + clock_offset
  std::optional<GimbalMount> gimbal = std::nullopt;
};

// An image that cannot be read. The source goes on with the next one.
class BrokenImage : public InputError {
 public:
  BrokenImage(const std::string& message, std::string frame_name, Time frame_time)
      : InputError(message), name(std::move(frame_name)), time(frame_time) {}

  std::string name;  // as in Frame
  Time time;
  std::size_t camera = 0;
};

// A source of frames, one after the other.
class FrameSource {
 public:
  virtual ~FrameSource() = default;

  // Sets the pixel format of the next frames; it is gray by default.
  void set_format(PixelFormat format) { format_ = format; }
  // The next frames also have their image in colour, for pictures of them; not by default.
  void set_keeps_color(bool keeps_color) { keeps_color_ = keeps_color; }

  // Called by Next with each image that cannot be read, in its place among the others.
  using OnBroken = std::function<void(const BrokenImage&)>;
  void set_on_broken(OnBroken on_broken) { on_broken_ = std::move(on_broken); }

  // Fills 'frame' with the next image that can be read; returns false at the end. Frames are in
  // order of time. An image that is missing, broken or of an unsupported kind (16 bits) is left
  // out. Throws InputError when the source fails as a whole: at its end when no image at all could
  // be read, and at the end of a video that is cut off.
  bool Next(Frame* frame);
  // Number of images that Next has left out.
  std::size_t left_out() const { return left_out_; }

  // Fills 'frame' with the image 'index', from 0; the position of Next does not change. Returns
  // false for sources without random access, such as videos, and when there is no such image.
  // Throws InputError when the image cannot be read.
  virtual bool Read(std::size_t /*index*/, Frame* /*frame*/) const { return false; }

  // Number of images, broken ones included, if known; for a video an estimate.
  virtual std::optional<std::size_t> frame_count() const = 0;
  virtual double rate_hz() const = 0;
  // The rate of one of several cameras.
  virtual double camera_rate_hz(std::size_t /*camera*/) const { return rate_hz(); }

  // Returns the source's own calibration; nothing if it has none. Throws InputError when it is not
  // valid.
  virtual std::optional<CameraCalibration> calibration() const { return std::nullopt; }
  // Returns the mount of the source's camera, with or without a calibration. Throws as
  // calibration().
  virtual CameraMount mount() const;
  // Returns the poses of the navigation, on its own clock, in order of time; empty if there are
  // none.
  virtual std::vector<PoseSample> poses() const { return {}; }
  // Returns the reports of the gimbal on which the camera is, on the gimbal's clock, in order of
  // time; empty if there are none.
  virtual std::vector<GimbalSample> gimbal() const { return {}; }
  // Returns the reports of the camera's zoom in the same way.
  virtual std::vector<ZoomSample> zoom() const { return {}; }

 protected:
  // As Next, but throws BrokenImage for an image that cannot be read.
  virtual bool ReadNext(Frame* frame) = 0;

  PixelFormat format() const { return format_; }
  bool keeps_color() const { return keeps_color_; }

 private:
  PixelFormat format_ = PixelFormat::kGray;
  bool keeps_color_ = false;
  OnBroken on_broken_;
  std::size_t given_ = 0, left_out_ = 0;
  std::string first_fault_;
};

}  // namespace kestrel
