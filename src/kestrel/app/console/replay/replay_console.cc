// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/app/console/replay/replay_console.h"

#include <thread>
#include <utility>

#include "kestrel/app/console/console_page.h"

namespace kestrel {
namespace {

ConsoleFeed::Description DescriptionWith(const std::string& title, const ReplaySubject& subject,
                                         bool has_colors) {
  ConsoleFeed::Description description = DescriptionOf(title, subject);
  for (const ConsoleCommandKind kind :
       {ConsoleCommandKind::kCalibrate, ConsoleCommandKind::kCalibrateCancel,
        ConsoleCommandKind::kCalibrateSave}) {
    description.offers.push_back(kind);
  }
  description.has_colors = has_colors;
  return description;
}

}  // namespace

ReplayConsole::ReplayConsole(const ConsoleOptions& options, const std::string& title,
                             ReplaySubject subject, std::optional<ColorSource> colors)
    : subject_(std::move(subject)),
      feed_(DescriptionWith(title, subject_, colors.has_value())),
      server_(ServeConsole(options, &feed_)) {
  if (colors) colors_.emplace(*std::move(colors), &feed_);
}

void ReplayConsole::Play(ReplayResult first, Recording recording,
                         const std::function<bool()>& is_stopped) {
  const std::size_t frames = first.frames.size();
  RecordingPlayer player(subject_, std::move(first), std::move(recording), &feed_);
  if (tools_.calibrate) calibration_.emplace(tools_, frames, &feed_);
  while (!is_stopped()) {
    while (const auto command = feed_.TakeCommand()) {
      player.Obey(*command);
      if (calibration_) calibration_->Obey(*command);
    }
    player.Follow();
    if (calibration_) calibration_->Follow();
    if (const auto pending = feed_.TakeExport()) AnswerExport(*pending, &player);
    std::this_thread::sleep_for(kLookInterval);
  }
}

void ReplayConsole::AnswerExport(const PendingExport& pending, RecordingPlayer* player) const {
  const ExportRequest& request = pending.request;
  if (request.kind != ExportRequest::Kind::kCalibration) return player->AnswerExport(pending);
  pending.answer(calibration_ ? calibration_->File(request.number) : ExportAnswer());
}

}  // namespace kestrel
