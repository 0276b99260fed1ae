// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/app/console/colors/color_page.h"

#include <sys/resource.h>
#include <utility>
#include <variant>

#include "kestrel/core/base/thread_setup.h"

namespace kestrel {
namespace {

// Greatest time before the threads notice that they must end.
constexpr Duration kJobPatience = std::chrono::milliseconds(100);
// The threads that fly have priority over the page, and the page over the scores.
constexpr int kFlightsPageNiceness = 10, kScoresNiceness = 15;

// On Linux this concerns this thread only.
void BeNice(int niceness) { setpriority(PRIO_PROCESS, 0, niceness); }

}  // namespace

ColorPage::ColorPage(ColorSource source, ConsoleFeed* feed)
    : feed_(feed), session_(std::move(source)) {
  server_ = std::thread([this] { Serve(); });
  scorer_ = std::thread([this] { Score(); });
}

ColorPage::~ColorPage() {
  is_stopped_ = true;
  exams_.Close();
  server_.join();
  scorer_.join();
}

void ColorPage::Serve() {
  SetUpThisThread("colors", {});
  if (session_.is_live()) BeNice(kFlightsPageNiceness);
  Notify();
  while (!is_stopped_) {
    const auto job = feed_->TakeColorJob(kJobPatience);
    if (!job) continue;
    if (const auto* pending = std::get_if<PendingExport>(&*job)) {
      pending->answer(session_.Answer(pending->request));
    } else {
      session_.Obey(std::get<ColorRequest>(*job));
      Notify();
    }
  }
}

void ColorPage::Notify() {
  const ConsoleColors& state = session_.state();
  feed_->Add(state);
  const ColorEditor& editor = session_.editor();
  exams_.Push({state.revision, editor.IndexOf(state.color), editor.model().colors, editor.grid(),
               editor.MarksFor(state.color)});
}

void ColorPage::Score() {
  SetUpThisThread("color scores", {});
  BeNice(kScoresNiceness);
  while (!is_stopped_) {
    const auto exam = exams_.Pop(kJobPatience);
    if (!exam) continue;
    feed_->Add(ConsoleColorScores{exam->revision, exam->model.colors[exam->color].name,
                                  ScoreColor(exam->model, exam->grid, exam->color, exam->marks)});
  }
}

}  // namespace kestrel
