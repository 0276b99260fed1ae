// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/io/bags/source_calibration.h"

#include "kestrel/core/camera/calibration_reader.h"
#include "kestrel/io/recording/media/image_sequence.h"

namespace kestrel {

std::optional<CameraCalibration> CalibrationOf(
    const FrameSource& source, const std::string& file,
    const std::function<void(const std::string&)>& notify, const std::string& camera) {
  const auto* const images = dynamic_cast<const ImageSequence*>(&source);
  const std::string read = file.empty() && images != nullptr ? images->calibration_file() : file;
  return read.empty() ? source.calibration() : ReadCalibration(read, camera, notify);
}

}  // namespace kestrel
