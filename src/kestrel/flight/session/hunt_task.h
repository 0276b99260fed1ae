// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "kestrel/flight/session/task.h"
#include "kestrel/io/recording/tables/object_csv.h"
#include "kestrel/vision/objects/color/color_grid.h"
#include "kestrel/vision/objects/object_model.h"
#include "kestrel/vision/pipeline/hunt_pipeline.h"

namespace kestrel {

// Looks for coloured objects, and makes a map of them.
class HuntTask : public Task {
 public:
  // 'grid': of the objects' colours; nothing: the model's own. 'origin': latitude and longitude
  // (degrees) of the world's origin, for the map; or empty. 'go': class of the objects to one of
  // which the UAV goes; empty: to none.
  HuntTask(HuntPipelineOptions options, ObjectModel model,
           std::optional<ColorGrid> grid = std::nullopt, std::vector<double> origin = {},
           std::string go = {});

  PixelFormat format() const override { return PixelFormat::kBgr; }
  std::string_view table() const override { return kObjectTable; }
  ResultTopics topics() const override { return kHuntTopics; }
  std::unique_ptr<Vision> MakeVision(const SessionCamera& camera) const override;

  const HuntPipelineOptions& options() const { return options_; }
  const ObjectModel& model() const { return model_; }

 private:
  HuntPipelineOptions options_;
  ObjectModel model_;
  ColorGrid grid_;
  std::vector<double> origin_;
  std::string go_;
};

}  // namespace kestrel
