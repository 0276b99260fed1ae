// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <memory>
#include <optional>

#include <opencv2/core.hpp>

#include "kestrel/flight/session/task.h"
#include "kestrel/io/recording/tables/follow_csv.h"
#include "kestrel/vision/pipeline/follow_pipeline.h"

namespace kestrel {

// Follows what a person has marked in an image.
class FollowTask : public Task {
 public:
  // 'mark': in a recording, which cannot do without; in flight it comes by Vision::Mark.
  explicit FollowTask(const FollowPipelineOptions& options,
                      const std::optional<FollowMark>& mark = std::nullopt);

  PixelFormat format() const override { return PixelFormat::kBgr; }
  std::string_view table() const override { return kFollowTable; }
  ResultTopics topics() const override { return kFollowTopics; }
  std::unique_ptr<Vision> MakeVision(const SessionCamera& camera) const override;

  const FollowPipelineOptions& options() const { return options_; }

 private:
  FollowPipelineOptions options_;
  std::optional<FollowMark> mark_;
};

}  // namespace kestrel
