// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace kestrel {

// The result of a variant for a recording. Nothing is known when its unit is not done, or failed.
struct StudyOutcome {
  std::string key = {};                    // key of the unit; empty: not done
  std::string failure = {};                // why it failed; empty: it did not
  std::int64_t frames = 0;                 // images of the recording
  std::int64_t found_count = 0;            // number of found targets
  std::optional<double> found = {};        // share of what should be found, 0 to 1
  std::optional<double> false_found = {};  // false detections for each image with something to find
  std::optional<std::int64_t> false_count = {};
  std::optional<double> error_m = {};  // median of the error of what was found, m
  bool is_estimated = false;           // the recording has no truth

  bool IsDone() const { return !key.empty() && failure.empty(); }
};

// A recording, or a piece of one, as two variants saw it.
struct StudyRow {
  std::string recording;
  std::int64_t piece = 0;  // from 1; 0: the whole recording
  std::string path;
  StudyOutcome before, after;

  // The share found in addition by the second, less its additional false detections; negative: it
  // got worse. Nothing when one of the two is not known.
  std::optional<double> Change() const {
    if (!before.found || !after.found) return std::nullopt;
    return (*after.found - *before.found) - (*after.false_found - *before.false_found);
  }
};

struct StudyComparison {
  std::vector<StudyRow> rows;  // what failed with the second only, then what got worst first
  std::size_t total = 0;       // number of rows before only the first of them were kept
  std::string judgement = {};  // StudyJudgement of all rows; empty: there is nothing to compare
};

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
