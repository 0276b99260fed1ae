// SPDX-License-Identifier: BSD-3-Clause
#include <string>

#include "kestrel/app/cli/test_running_command.h"
#include "kestrel/app/console/study/test_study.h"
#include "kestrel/app/web_server/test_browser.h"

namespace kestrel {
namespace {

using ::testing::HasSubstr;

class ConsoleStudyTest : public CommandTest {};

// Waits until the recording is replayed, or cannot be.
nlohmann::json OpenFirstRow(TestSocket* socket) {
  socket->Await("study");
  socket->Send(R"({"command": "open", "value": 0})");
  nlohmann::json replay = socket->Await("study-replay");
  while (replay["state"] == "none" || replay["state"] == "running") {
    replay = socket->Await("study-replay");
  }
  return replay;
}

TEST_F(ConsoleStudyTest, ReplaysRowWithBothConfigurationsAtWorstFrame) {
  const std::string flight =
      Simulate("landing", "--scenario calm --seed 2 --set frames=10 --set rate_hz=10");
  const std::string table = ReadFile(flight + "/mav0/cam0/data.csv");
  const std::string first = table.substr(table.find('\n') + 1);
  const TestStudy study(folder_);
  study.AddDone("calm", "usual", 10, 0, flight, std::stol(first));
  study.AddDone("calm", "strict", 6, 0, flight, std::stol(first));
  RunningCommand console("console " + study.path() + " --address 127.0.0.1:0", folder_);
  TestSocket socket(console.Port());
  const nlohmann::json timeline_before = OpenFirstRow(&socket);
  EXPECT_EQ(timeline_before["state"], "open") << timeline_before;
  EXPECT_EQ(timeline_before["before"], "usual");
  while (socket.Await("playback")["frame"] != 6) continue;
  nlohmann::json second = socket.Await("second");
  while (second["state"] == "running") second = socket.Await("second");
  EXPECT_EQ(second["state"], "done") << second;
  EXPECT_EQ(second["settings"], nlohmann::json{"strict"});
  EXPECT_EQ(second["marks"], std::string(10, 'l')) << "no detection is as sure as this";
  TestBrowser browser(console.Port());
  EXPECT_THAT(browser.Send(browser.Get("/export/overlays-6.png")).body(), HasSubstr("PNG"));
  EXPECT_EQ(console.End(), 0) << console.Log();
}

TEST_F(ConsoleStudyTest, ReportsRecordingOnAnotherHost) {
  const TestStudy study(folder_);
  study.AddDone("calm", "usual", 10, 0, "sftp://nas/calm");
  RunningCommand console("console " + study.path() + " --address 127.0.0.1:0", folder_);
  TestSocket socket(console.Port());
  const nlohmann::json replay = OpenFirstRow(&socket);
  EXPECT_EQ(replay["state"], "failed");
  EXPECT_EQ(replay["error"], "the recording is not on this computer: sftp://nas/calm");
  EXPECT_EQ(console.End(), 0) << console.Log();
}

TEST_F(ConsoleStudyTest, RefusesNonStudyInOneLine) {
  const std::string folder = folder_ / "study";
  folder_.Write("study/study.db", "");
  ExpectInputError("console " + folder,
                   "study.db: not the results of a study: has no table 'unit'");
}

}  // namespace
}  // namespace kestrel
