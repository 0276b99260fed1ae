// SPDX-License-Identifier: BSD-3-Clause
// Any content of a calibration file gives a usable camera, or is refused with an InputError of one
// line.
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <string_view>

#include "kestrel/core/base/error.h"
#include "kestrel/core/camera/calibration_reader.h"
#include "kestrel/core/camera/ray_table.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string_view text(reinterpret_cast<const char*>(data), size);
  try {
    const kestrel::CameraCalibration calibration = kestrel::ParseCalibration(text, "fuzz");
    const kestrel::RayTable rays{kestrel::CameraModel(calibration.intrinsics)};
    const float u_px = static_cast<float>(calibration.intrinsics.width_px);
    rays.Ray(u_px, 0);
  } catch (const kestrel::InputError& error) {
    if (std::string_view(error.what()).find('\n') != std::string_view::npos) std::abort();
  }
  return 0;
}
