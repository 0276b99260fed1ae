// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/app/console/study/study_console.h"

#include <algorithm>
#include <thread>
#include <utility>

#include <fmt/format.h>

#include "kestrel/app/console/console_page.h"
#include "kestrel/core/base/error.h"
#include "kestrel/core/base/parse_number.h"

namespace kestrel {
namespace {

constexpr Duration kProgressInterval = std::chrono::milliseconds(250);

ConsoleFeed::Description StudyDescription(const std::string& title, const ReplaySubject& subject) {
  ConsoleFeed::Description description = DescriptionOf(title, subject);
  description.offers.push_back(ConsoleCommandKind::kCompare);
  description.offers.push_back(ConsoleCommandKind::kOpen);
  return description;
}

// The configuration's name, with its version where others have the same name.
std::string NameIn(const std::vector<StudyVariant>& variants, const StudyVariant& variant) {
  const auto count = std::count_if(variants.begin(), variants.end(), [&](const auto& other) {
    return other.configuration == variant.configuration;
  });
  return count == 1 ? variant.configuration
                    : fmt::format("{} ({})", variant.configuration, variant.version);
}

std::string NameOfRow(const StudyRow& row) {
  return row.piece == 0 ? row.recording : fmt::format("{}, piece {}", row.recording, row.piece);
}

}  // namespace

StudyConsole::StudyConsole(const ConsoleOptions& options, const std::string& title,
                           StudyResults results, std::vector<StudyVariant> variants,
                           ReplaySubject subject, Open open)
    : results_(std::move(results)),
      variants_(std::move(variants)),
      subject_(std::move(subject)),
      open_(std::move(open)),
      feed_(StudyDescription(title, subject_)),
      server_(ServeConsole(options, &feed_)) {
  for (const StudyVariant& variant : variants_) {
    study_.variants.push_back(NameIn(variants_, variant));
  }
}

void StudyConsole::Play(const std::function<bool()>& is_stopped) {
  ReadTable(0, std::min<std::size_t>(1, variants_.size() - 1));
  ReportReplay(StudyReplayState::kNone);
  while (!is_stopped()) {
    while (const auto command = feed_.TakeCommand()) Obey(*command);
    FollowFirstRun();
    if (player_) player_->Follow();
    if (const auto pending = feed_.TakeExport()) {
      if (player_) player_->AnswerExport(*pending);
      if (!player_) pending->answer({});
    }
    std::this_thread::sleep_for(kLookInterval);
  }
}

void StudyConsole::Obey(const ConsoleCommand& command) {
  if (command.kind == ConsoleCommandKind::kCompare) return Compare(command.settings);
  if (command.kind == ConsoleCommandKind::kOpen) return OpenRow(command.value);
  if (player_) return player_->Obey(command);
  if (command.kind == ConsoleCommandKind::kCancel && first_run_.Cancel()) {
    ReportReplay(StudyReplayState::kCancelled);
  }
}

void StudyConsole::Compare(const std::vector<std::string>& settings) {
  if (settings.size() != 2) return;
  const auto before = ParseNumber<std::size_t>(settings[0]);
  const auto after = ParseNumber<std::size_t>(settings[1]);
  if (!before || !after || std::max(*before, *after) >= variants_.size()) return;
  ReadTable(*before, *after);
}

void StudyConsole::ReadTable(std::size_t before, std::size_t after) {
  study_.before = before;
  study_.after = after;
  study_.remark.clear();
  study_.error.clear();
  study_.comparison = {};
  if (variants_[before].version != variants_[after].version) {
    study_.remark =
        "The two were run by different versions of the program. A replay runs both with the "
        "version that serves this page: what differs by version alone is not seen in it.";
  }
  try {
    study_.comparison = results_.Compare(variants_[before], variants_[after]);
  } catch (const InputError& error) {  // the file was changed or removed meanwhile
    study_.error = error.what();
  }
  feed_.Add(study_);
}

void StudyConsole::OpenRow(double number) {
  const std::vector<StudyRow>& rows = study_.comparison.rows;
  if (number < 0 || number >= static_cast<double>(rows.size())) return;
  const StudyRow& row = rows[static_cast<std::size_t>(number)];
  first_run_.Cancel();
  player_.reset();
  replay_ = {};
  replay_.recording = NameOfRow(row);
  replay_.before = study_.variants[study_.before];
  replay_.after = study_.variants[study_.after];
  replay_.frames = std::max(row.before.frames, row.after.frames);
  try {
    StartFirstRun(row);
  } catch (const InputError& error) {
    ReportReplay(StudyReplayState::kFailed, error.what());
  }
}

StudyConsole::Run StudyConsole::OpenFor(const StudyRow& row, std::size_t variant) const {
  return open_(row.path, variants_[variant], results_.OptionsOf(variants_[variant]));
}

void StudyConsole::StartFirstRun(const StudyRow& row) {
  worst_ = results_.WorstFrame(row);
  before_ = OpenFor(row, study_.before);
  after_ = OpenFor(row, study_.after);
  first_run_.Start("first run", RecordingOf(before_.choice, *before_.search).detect({}));
  ReportReplay(StudyReplayState::kRunning);
}

void StudyConsole::FollowFirstRun() {
  if (auto outcome = first_run_.TakeOutcome()) {
    if (!outcome->result) return ReportReplay(StudyReplayState::kFailed, outcome->error);
    if (outcome->result->frames.empty()) {
      return ReportReplay(StudyReplayState::kFailed, "the recording has no images to show");
    }
    return StartReplay(*std::move(outcome->result));
  }
  if (first_run_.is_running() && Now() - reported_ > kProgressInterval) {
    ReportReplay(StudyReplayState::kRunning);
  }
}

void StudyConsole::StartReplay(ReplayResult first) {
  ReplaySubject subject = before_.search->Subject();
  subject.has_truth = subject_.has_truth;  // as the page knows it
  try {
    player_.emplace(subject, std::move(first), RecordingOf(before_.choice, *before_.search),
                    &feed_);
    if (worst_) player_->Seek(*worst_);
    player_->StartSecondRun({replay_.after}, RecordingOf(after_.choice, *after_.search).detect({}));
  } catch (const InputError& error) {  // the recording is gone
    player_.reset();
    return ReportReplay(StudyReplayState::kFailed, error.what());
  }
  ReportReplay(StudyReplayState::kOpen);
}

void StudyConsole::ReportReplay(StudyReplayState state, const std::string& error) {
  reported_ = Now();
  replay_.state = state;
  replay_.done = first_run_.done();
  replay_.error = error;
  feed_.Add(replay_);
}

}  // namespace kestrel
