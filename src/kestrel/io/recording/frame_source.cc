// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/io/recording/frame_source.h"

#include <fmt/format.h>

namespace kestrel {

bool FrameSource::Next(Frame* frame) {
  for (;;) {
    try {
      const bool has_frame = ReadNext(frame);
      if (!has_frame && given_ == 0 && left_out_ == 1) throw InputError(first_fault_);
      if (!has_frame && given_ == 0 && left_out_ > 1) {
        throw InputError(
            fmt::format("none of {} images can be read; the first: {}", left_out_, first_fault_));
      }
      given_ += has_frame ? 1 : 0;
      return has_frame;
    } catch (const BrokenImage& broken) {
      if (left_out_++ == 0) first_fault_ = broken.what();
      if (on_broken_) on_broken_(broken);
    }
  }
}

CameraMount FrameSource::mount() const {
  const std::optional<CameraCalibration> own = calibration();
  return own ? CameraMount{own->body_from_camera, own->clock_offset, own->gimbal} : CameraMount();
}

}  // namespace kestrel
