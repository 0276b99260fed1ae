// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/simulation/recordings/zooming_camera.h"

#include <limits>
#include <utility>

namespace kestrel {

ZoomingCamera::ZoomingCamera(const ZoomOptions& options, const CameraIntrinsics& lens, Make make)
    : options_(options), lens_(lens), make_(std::move(make)), first_(make_(lens)), last_(first_) {
  constexpr double kEnd_s = std::numeric_limits<double>::infinity();
  if (options.is_there()) last_ = make_(ZoomedLens(options, lens, kEnd_s));
}

std::shared_ptr<const FlightCamera> ZoomingCamera::At(double time_s) const {
  if (time_s < options_.at_s) return first_;
  const bool moves = options_.is_there() && time_s < options_.at_s + options_.takes_s;
  return moves ? make_(ZoomedLens(options_, lens_, time_s)) : last_;
}

}  // namespace kestrel
