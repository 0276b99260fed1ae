// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>

#include "kestrel/app/foxglove/foxglove_sink.h"
#include "kestrel/app/foxglove/foxglove_topics.h"
#include "kestrel/core/camera/camera_model.h"
#include "kestrel/core/codec/jpeg_codec.h"
#include "kestrel/io/recording/frame.h"

namespace kestrel {

// Writes frames as /camera/image (foxglove.CompressedImage, JPEG) and with each, if they are known,
// the intrinsics as /camera/calibration (foxglove.CameraCalibration); or as other topics.
class CameraWriter {
 public:
  // 'sink' outlives this.
  CameraWriter(FoxgloveSink* sink, const std::optional<CameraIntrinsics>& camera,
               CameraTopics topics = CameraTopics());

  // 'time': of the messages. Throws InputError when the sink cannot write, or the frame is neither
  // 8-bit gray nor BGR.
  void Write(const Frame& frame, Time time);

  const CameraTopics& topics() const { return topics_; }

 private:
  FoxgloveSink* sink_;
  std::optional<CameraIntrinsics> camera_;
  JpegEncoder encoder_;
  CameraTopics topics_;
};

}  // namespace kestrel
