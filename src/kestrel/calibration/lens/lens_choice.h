// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <utility>
#include <vector>

#include "kestrel/calibration/lens/lens_fit.h"
#include "kestrel/calibration/lens/lens_view.h"
#include "kestrel/core/camera/camera_model.h"

namespace kestrel {

// Chooses the distortion model and the number of coefficients that explain views best.
class LensChoice {
 public:
  // 'model': the distortion model, if it is known.
  LensChoice(std::vector<LensView> views, std::optional<DistortionModel> model)
      : views_(std::move(views)), model_(model) {}

  // Returns a lens near the best one, from one that may be far off. Gives the views the poses of
  // that lens and leaves out edges and views that it does not explain. Returns nothing when no lens
  // shows the views.
  std::optional<CameraIntrinsics> Approach(const CameraIntrinsics& start);

  // Returns the best fit of all models, numbers of coefficients and aspects, from a lens that is
  // near: the one with the least sum of cost and expected optimism (Takeuchi's information
  // criterion, with the factor of BIC). Gives the views its poses. Returns nothing when no lens
  // shows them.
  std::optional<LensFit> Choose(const CameraIntrinsics& start);

  const std::vector<LensView>& views() const { return views_; }
  int outliers() const { return outliers_; }  // views that were left out

 private:
  bool Resect(const CameraIntrinsics& lens);
  std::vector<DistortionModel> Kinds() const;
  std::optional<LensFit> FitKind(const CameraIntrinsics& start, DistortionModel kind) const;
  std::optional<LensFit> FitOrder(const LensFit& fit, int order) const;
  std::optional<LensFit> Refit(const LensFit& fit, const CameraIntrinsics& start,
                               const LensFreedom& freedom) const;
  std::optional<LensFit> BestOrder(const CameraIntrinsics& start, DistortionModel kind) const;
  void Clean(const LensFit& fit);

  std::vector<LensView> views_;
  std::optional<DistortionModel> model_;
  double edge_sigma_px_ = 0.5;  // initial value
  int outliers_ = 0;
};

}  // namespace kestrel
