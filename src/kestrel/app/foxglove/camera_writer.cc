// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/app/foxglove/camera_writer.h"

#include <utility>

#include "kestrel/app/foxglove/observation_messages.h"
#include "kestrel/core/base/error.h"

namespace kestrel {
namespace {

constexpr int kJpegQuality = 85;

}  // namespace

CameraWriter::CameraWriter(FoxgloveSink* sink, const std::optional<CameraIntrinsics>& camera,
                           CameraTopics topics)
    : sink_(sink), camera_(camera), encoder_(kJpegQuality), topics_(std::move(topics)) {}

void CameraWriter::Write(const Frame& frame, Time time) {
  sink_->Offer(FoxgloveTopic<foxglove::CompressedImage>{topics_.image}, time, [&] {
    foxglove::CompressedImage message{time, topics_.frame, {}, "jpeg"};
    if (!encoder_.Append(frame.image, &message.data.bytes)) {
      throw InputError(frame.name + ": is neither 8-bit gray nor BGR");
    }
    return message;
  });
  if (!camera_) return;
  foxglove::CameraCalibration calibration = FoxgloveCalibration(time, *camera_);
  calibration.frame_id = topics_.frame;
  sink_->Write(FoxgloveTopic<foxglove::CameraCalibration>{topics_.calibration}, time, calibration);
}

}  // namespace kestrel
