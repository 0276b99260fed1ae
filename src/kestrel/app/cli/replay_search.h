// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "kestrel/app/cli/pipeline_run.h"
#include "kestrel/app/cli/source_arguments.h"
#include "kestrel/app/console/replay_console.h"
#include "kestrel/app/console/replay_frame.h"
#include "kestrel/io/recording/frame.h"

namespace kestrel {

// A pipeline that runs over a recording, or its earlier results, kept for the page.
class ReplayRun : public PipelineRun {
 public:
  // 'tell' is called now and then with the number of frames done.
  void TellProgress(std::function<void(std::size_t done)> tell) { tell_ = std::move(tell); }

  Duration Process(const Frame& frame) final;
  std::string Remarks() const override { return ""; }

  std::size_t done() const { return result_.frames.size(); }

  // Call it once, after the last frame. Returns all frames with their marks. Throws InputError when
  // the truth, or the earlier result, belongs to another recording.
  ReplayResult TakeResult();

 protected:
  // Adds the content of a frame. Returns the time of the detection alone.
  virtual Duration Add(const Frame& frame, ReplayResult* result) = 0;
  // Adds what is known only after the last frame.
  virtual void Complete(ReplayResult* result) = 0;

 private:
  std::function<void(std::size_t)> tell_;
  ReplayResult result_;
};

// The search of `kestrel console` in a recording. It outlives the runs and the subject it gives.
class ReplaySearch {
 public:
  using StartRun = std::function<std::unique_ptr<ReplayRun>(const OpenedSource& opened)>;

  virtual ~ReplaySearch() = default;

  // Pixel format that the pipeline takes.
  virtual PixelFormat format() const = 0;
  virtual ReplaySubject Subject() const = 0;
  // Runs the pipeline with the command's options changed by these settings. Throws InputError for
  // settings that are not valid or that the page may not change.
  virtual StartRun Detect(const std::vector<std::string>& settings) const = 0;
  // Shows an earlier result.
  virtual StartRun Show(const std::string& table) const = 0;
};

// Runs over the recording once more with 'start'; returns nothing when it was told to end.
std::optional<ReplayResult> DetectAgain(const SourceArguments& source, PixelFormat format,
                                        const ReplaySearch::StartRun& start,
                                        const SecondRun::GoOn& go_on);

// Returns the recording with known truth: the only source, if it is a folder with the true poses
// and a table of this name with what can be found, as "landing_pattern0/data.csv".
std::optional<std::string> FindTruth(const std::vector<std::string>& sources,
                                     const std::string& table_name);

}  // namespace kestrel
