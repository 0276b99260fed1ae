// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "kestrel/app/console/background_run.h"
#include "kestrel/app/console/messages/console_feed.h"
#include "kestrel/app/console/messages/study_state.h"
#include "kestrel/app/console/replay/recording_player.h"
#include "kestrel/app/console/replay/replay_search.h"
#include "kestrel/app/console/study/study_results.h"
#include "kestrel/app/web_server/console_options.h"
#include "kestrel/app/web_server/web_server.h"

namespace kestrel {

// The results of a study on the page: the table of its recordings, the worst first, and the replay
// of one of them, whose two runs are by the two variants that are compared.
class StudyConsole {
 public:
  // A recording, and the search in it with the options of a variant.
  struct Run {
    RecordingChoice choice;
    std::unique_ptr<ReplaySearch> search;
  };
  // Opens a recording of the study for a variant, with the options of its run. Throws InputError.
  using Open = std::function<Run(const std::string& path, const StudyVariant& variant,
                                 const StudyOptions& options)>;

  // Starts the server. 'variants': those of the results, in the order of the page; at least one.
  // 'subject': of the searches that 'open' makes. Throws InputError as WebServer does.
  StudyConsole(const ConsoleOptions& options, const std::string& title, StudyResults results,
               std::vector<StudyVariant> variants, ReplaySubject subject, Open open);

  // As WebServer::urls.
  std::vector<std::string> urls() const { return server_.urls(); }

  // Shows what the users request, until 'is_stopped' returns true; it is called often.
  void Play(const std::function<bool()>& is_stopped);

 private:
  void Obey(const ConsoleCommand& command);
  void Compare(const std::vector<std::string>& settings);
  void ReadTable(std::size_t before, std::size_t after);
  void OpenRow(double number);
  Run OpenFor(const StudyRow& row, std::size_t variant) const;
  void StartFirstRun(const StudyRow& row);
  void FollowFirstRun();
  void StartReplay(ReplayResult first);
  void ReportReplay(StudyReplayState state, const std::string& error = "");

  StudyResults results_;
  std::vector<StudyVariant> variants_;
  ReplaySubject subject_;
  Open open_;
  ConsoleFeed feed_;
  WebServer server_;
  ConsoleStudy study_;
  // The recording that is being opened or is replayed.
  ConsoleStudyReplay replay_;
  std::optional<Time> worst_;  // its frame to begin with
  Run before_, after_;
  Time reported_{};
  BackgroundRun<ReplayResult> first_run_;
  std::optional<RecordingPlayer> player_;
};

}  // namespace kestrel
