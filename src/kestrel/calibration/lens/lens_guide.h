// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <string>
#include <vector>

#include <opencv2/core.hpp>

#include "kestrel/calibration/lens/lens_calibration.h"
#include "kestrel/calibration/lens/lens_view.h"
#include "kestrel/core/base/time.h"

namespace kestrel {

// Variety of the views of a board, which a calibration needs.
struct LensVariety {
  LensCoverage coverage;
  // Number of views in which this side of the board is nearer than the other.
  int left = 0, right = 0, top = 0, bottom = 0;
  int near = 0, far = 0;  // number of views in which the board is large, and small
};

// Chooses the views of a live camera that a calibration is made of, and advises what to show next.
class LensGuide {
 public:
  explicit LensGuide(const cv::Size& image) : image_(image) {}

  // Takes the view when the board is still and the view differs from those before. 'view': nothing
  // when the board was not found; its pose by 'camera'. Returns whether it was taken.
  bool Look(std::optional<LensView> view, Time time, const CameraIntrinsics& camera);

  const std::vector<LensView>& views() const { return views_; }
  const LensVariety& variety() const { return variety_; }
  bool is_complete() const { return Missing().empty(); }

  // Returns what to do next, in words: "hold it still", "bring the board to the upper left corner".
  std::string Advice() const;

 private:
  enum class Sight { kNone, kMoves, kKnown, kTaken };

  bool IsStill(const LensView& view, Time time) const;
  bool IsNew(const LensView& view) const;
  void Count(const LensView& view, const CameraIntrinsics& camera);
  std::string Missing() const;

  cv::Size image_;
  std::vector<LensView> views_;
  LensVariety variety_;
  std::optional<LensView> last_;  // the newest view in which the board was found
  Time last_time_{};
  Sight sight_ = Sight::kNone;
};

}  // namespace kestrel
