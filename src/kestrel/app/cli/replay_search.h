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

// A pipeline over a recording, or what it found before, kept for the page.
class ReplayRun : public PipelineRun {
 public:
  // Is told now and then how many frames are done.
  void TellProgress(std::function<void(std::size_t done)> tell) { tell_ = std::move(tell); }

  Duration Process(const Frame& frame) final;
  std::string Remarks() const override { return ""; }

  std::size_t done() const { return result_.frames.size(); }

  // After the last frame, once: all frames with their marks. Throws InputError when the truth, or
  // what was found before, is of another recording.
  ReplayResult TakeResult();

 protected:
  // Adds what the frame shows. Returns the time of the detection alone.
  virtual Duration Add(const Frame& frame, ReplayResult* result) = 0;
  // What is known after the last frame only.
  virtual void Complete(ReplayResult* result) = 0;

 private:
  std::function<void(std::size_t)> tell_;
  ReplayResult result_;
};

// What `kestrel console` looks for in a recording. Outlives what it gives.
class ReplaySearch {
 public:
  using StartRun = std::function<std::unique_ptr<ReplayRun>(const OpenedSource& opened)>;

  virtual ~ReplaySearch() = default;

  // Of the images that the pipeline takes.
  virtual PixelFormat format() const = 0;
  virtual ReplaySubject Subject() const = 0;
  // The pipeline, with options as the command has them but for these settings. Throws InputError
  // for settings that are not valid or not for the page.
  virtual StartRun Detect(const std::vector<std::string>& settings) const = 0;
  // What was found before.
  virtual StartRun Show(const std::string& table) const = 0;
};

// Runs over the recording once more by 'start'; nothing when it is to end before.
std::optional<ReplayResult> DetectAgain(const SourceArguments& source, PixelFormat format,
                                        const ReplaySearch::StartRun& start,
                                        const SecondRun::GoOn& go_on);

// The recording whose truth is known: the only source, a folder that has a table of that name with
// what there is to be found, as "landing_pattern0/data.csv", and the true poses.
std::optional<std::string> FindTruth(const std::vector<std::string>& sources,
                                     const std::string& table_name);

}  // namespace kestrel
