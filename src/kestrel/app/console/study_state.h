// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "kestrel/app/console/study_results.h"

namespace kestrel {

// The table of a study: its recordings as two of its variants saw them.
struct ConsoleStudy {
  std::vector<std::string> variants;  // their names
  std::size_t before = 0, after = 0;  // the two that are compared, of 'variants'
  StudyComparison comparison;
  std::string remark;  // what a reader should know of the two; empty: nothing
  std::string error;   // why the table could not be read
};

// A recording of the study that is being opened, or is replayed.
enum class StudyReplayState { kNone, kRunning, kOpen, kCancelled, kFailed };
struct ConsoleStudyReplay {
  StudyReplayState state = StudyReplayState::kNone;
  std::string recording;      // with its piece
  std::string before, after;  // names of the variants: first and second run
  std::size_t done = 0;       // frames of the first run
  std::int64_t frames = 0;    // number of them, as the study has it; 0: not known
  std::string error;          // why it cannot be replayed
};

}  // namespace kestrel
