// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "kestrel/flight/session/task.h"
#include "kestrel/io/recording/tables/landing_csv.h"
#include "kestrel/vision/pipeline/landing_pipeline.h"

namespace kestrel {

// Looks for the pad to land on. 'predict_s': horizons of predictions, in a recording's tables.
class LandTask : public Task {
 public:
  explicit LandTask(LandingPipelineOptions options, std::vector<double> predict_s = {})
      : options_(std::move(options)), predict_s_(std::move(predict_s)) {}

  PixelFormat format() const override { return PixelFormat::kGray; }
  std::string_view table() const override { return kLandingTable; }
  bool takes_several_cameras() const override { return true; }
  ResultTopics topics() const override { return kLandingTopics; }
  std::unique_ptr<Vision> MakeVision(const SessionCamera& camera) const override;

  const LandingPipelineOptions& options() const { return options_; }

 private:
  LandingPipelineOptions options_;
  std::vector<double> predict_s_;
};

}  // namespace kestrel
