// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "kestrel/app/console/replay/replay_console.h"
#include "kestrel/app/console/replay/replay_run.h"
#include "kestrel/io/bags/open_recording.h"

namespace kestrel {

// The search of `kestrel console` in a recording. It outlives the runs and the subject it gives.
class ReplaySearch {
 public:
  using StartRun = std::function<ReplayRun(const OpenedSource& opened)>;

  virtual ~ReplaySearch() = default;

  // Pixel format that the pipeline takes.
  virtual PixelFormat format() const = 0;
  virtual ReplaySubject Subject() const = 0;
  // Runs the pipeline with the search's options changed by these settings. Throws InputError for
  // settings that are not valid or that the page may not change.
  virtual StartRun Detect(const std::vector<std::string>& settings) const = 0;
  // Shows an earlier result.
  virtual StartRun Show(const std::string& table) const = 0;
};

// Returns the access of the page to the recording that 'choice' names. 'search' outlives it.
ReplayConsole::Recording RecordingOf(const RecordingChoice& choice, const ReplaySearch& search);

// Returns the recording with known truth: the only source, if it is a folder with the true poses
// and a table of this name with what can be found, as "landing_pattern0/data.csv".
std::optional<std::string> FindTruth(const std::vector<std::string>& sources,
                                     const std::string& table_name);

}  // namespace kestrel
