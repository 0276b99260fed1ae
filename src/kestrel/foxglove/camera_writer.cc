// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/foxglove/camera_writer.h"

#include "kestrel/base/error.h"
#include "kestrel/foxglove/foxglove_messages.h"
#include "kestrel/foxglove/observation_messages.h"

namespace kestrel {
namespace {

constexpr int kJpegQuality = 85;

}  // namespace

CameraWriter::CameraWriter(FoxgloveFile* file, const std::optional<CameraIntrinsics>& camera)
    : file_(file), camera_(camera), encoder_(kJpegQuality) {}

void CameraWriter::Write(const Frame& frame) {
  foxglove::CompressedImage message{frame.time, kFoxgloveCamera, {}, "jpeg"};
  if (!encoder_.Append(frame.image, &message.data.bytes)) {
    throw InputError(frame.name + ": is neither 8-bit gray nor BGR");
  }
  file_->Write("/camera/image", frame.time, message);
  if (!camera_) return;
  file_->Write("/camera/calibration", frame.time, FoxgloveCalibration(frame.time, *camera_));
}

}  // namespace kestrel
