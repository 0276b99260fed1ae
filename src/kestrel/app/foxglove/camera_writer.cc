// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/app/foxglove/camera_writer.h"

#include "kestrel/app/foxglove/foxglove_topics.h"
#include "kestrel/app/foxglove/observation_messages.h"
#include "kestrel/core/base/error.h"

namespace kestrel {
namespace {

constexpr int kJpegQuality = 85;

}  // namespace

CameraWriter::CameraWriter(FoxgloveSink* sink, const std::optional<CameraIntrinsics>& camera)
    : sink_(sink), camera_(camera), encoder_(kJpegQuality) {}

void CameraWriter::Write(const Frame& frame) {
  sink_->Offer(kImageTopic, frame.time, [&] {
    foxglove::CompressedImage message{frame.time, kFoxgloveCamera, {}, "jpeg"};
    if (!encoder_.Append(frame.image, &message.data.bytes)) {
      throw InputError(frame.name + ": is neither 8-bit gray nor BGR");
    }
    return message;
  });
  if (!camera_) return;
  sink_->Write(kCalibrationTopic, frame.time, FoxgloveCalibration(frame.time, *camera_));
}

}  // namespace kestrel
