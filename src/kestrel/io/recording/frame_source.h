// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "kestrel/core/base/time.h"
#include "kestrel/core/camera/calibration.h"
#include "kestrel/core/geometry/rigid_transform.h"
#include "kestrel/core/poses/pose_history.h"
#include "kestrel/io/recording/frame.h"

namespace kestrel {

// Frames per second where a source does not say: images that are just files.
inline constexpr double kNominalRateHz = 30;

// How a camera is mounted, as far as that is known.
struct CameraMount {
  std::optional<RigidTransform> body_from_camera;
  std::optional<Duration> clock_offset;  // t_nav = t_image + clock_offset
};

// Where frames come from, one after the other.
class FrameSource {
 public:
  virtual ~FrameSource() = default;

  // What the next frames shall be; gray unless asked otherwise.
  void set_format(PixelFormat format) { format_ = format; }

  // Fills 'frame' with the next image; false at the end. Frames are in order of time. Throws
  // InputError when an image is missing, broken or of a kind that is not read (16 bits), and at the
  // end of a video that ends before it should.
  virtual bool Next(Frame* frame) = 0;

  // Fills 'frame' with the image 'index', from 0, wherever Next is; false where a source cannot go
  // to and fro, as a video, and where there is no such image. Throws InputError as Next does.
  virtual bool Read(std::size_t /*index*/, Frame* /*frame*/) const { return false; }

  // How many frames there are, when that is known; of a video it is what the container says.
  virtual std::optional<std::size_t> frame_count() const = 0;
  virtual double rate_hz() const = 0;

  // The source's own calibration; nothing if it has none. Throws InputError when it is at fault.
  virtual std::optional<CameraCalibration> calibration() const { return std::nullopt; }
  // What the source tells of its camera's mount, be there a calibration or not. Throws as above.
  virtual CameraMount mount() const;
  // What the navigation reported, on its own clock, in order of time; empty if it said nothing.
  virtual std::vector<PoseSample> poses() const { return {}; }

 protected:
  PixelFormat format() const { return format_; }

 private:
  PixelFormat format_ = PixelFormat::kGray;
};

inline CameraMount FrameSource::mount() const {
  const std::optional<CameraCalibration> own = calibration();
  return own ? CameraMount{own->body_from_camera, own->clock_offset} : CameraMount();
}

}  // namespace kestrel
