// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/app/console/calibration/calibration_page.h"

#include <chrono>
#include <utility>

#include "kestrel/core/base/error.h"
#include "kestrel/io/recording/euroc/euroc_text.h"

namespace kestrel {
namespace {

constexpr Duration kCalibrationInterval = std::chrono::milliseconds(250);

}  // namespace

CalibrationPage::CalibrationPage(Tools tools, std::size_t frames, ConsoleFeed* feed)
    : tools_(std::move(tools)), frames_(frames), feed_(feed) {
  Notify();
}

void CalibrationPage::Obey(const ConsoleCommand& command) {
  if (command.kind == ConsoleCommandKind::kCalibrate) return Start(command.settings);
  if (command.kind == ConsoleCommandKind::kCalibrateSave) return Save();
  if (command.kind != ConsoleCommandKind::kCalibrateCancel || !run_.is_running()) return;
  run_.RequestEnd();
  report_.is_ending = true;
  Notify();
}

void CalibrationPage::Start(const std::vector<std::string>& words) {
  if (run_.is_running()) return;
  result_.reset();
  const std::size_t number = report_.number + 1;
  report_ = {};
  report_.number = number;
  report_.requested = words;
  report_.of = frames_;
  try {
    request_ = ParseCalibrationRequest(words);
  } catch (const InputError& error) {
    return Refuse(error.what());
  }
  report_.state = CalibrationState::kRunning;
  run_.Start("calibration", [this, request = request_](const Run::GoOn& go_on) {
    return tools_.calibrate(request, go_on);
  });
  Notify();
}

void CalibrationPage::Follow() {
  if (auto outcome = run_.TakeOutcome()) return End(*std::move(outcome));
  if (run_.is_running() && Now() - reported_ > kCalibrationInterval) Notify();
}

void CalibrationPage::End(Run::Outcome outcome) {
  report_.is_ending = false;
  if (!outcome.error.empty()) return Refuse(outcome.error);
  if (!outcome.result) {
    report_.state = CalibrationState::kCancelled;
    return Notify();
  }
  ConsoleCalibration& found = outcome.result->report;
  found.number = report_.number;
  found.requested = report_.requested;
  found.done = found.of = frames_;
  report_ = std::move(found);
  if (report_.error.empty()) {
    report_.state = CalibrationState::kDone;
    result_ = std::move(outcome.result);
  } else {
    report_.state = CalibrationState::kRefused;
  }
  Notify();
}

void CalibrationPage::Refuse(const std::string& error) {
  report_.state = CalibrationState::kRefused;
  report_.error = error;
  Notify();
}

void CalibrationPage::Save() {
  if (!result_ || !tools_.save) return;
  report_.save_error.clear();
  try {
    report_.saved = tools_.save(request_.Name(), *result_);
  } catch (const InputError& error) {
    report_.save_error = error.what();
  }
  Notify();
}

ExportAnswer CalibrationPage::File(std::size_t number) const {
  if (!result_ || number != report_.number) return {};
  return {EurocCalibrationText(result_->calibration, result_->rate_hz), "application/yaml",
          request_.Name() + ".yaml"};
}

void CalibrationPage::Notify() {
  reported_ = Now();
  report_.can_save = tools_.save != nullptr && report_.no_use.empty();
  if (report_.state == CalibrationState::kRunning) report_.done = run_.done();
  feed_->Add(report_);
}

}  // namespace kestrel
