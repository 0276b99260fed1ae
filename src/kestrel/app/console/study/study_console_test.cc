// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/app/console/study/study_console.h"

#include <atomic>
#include <thread>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "kestrel/app/console/replay/landing_replay.h"
#include "kestrel/app/console/study/test_study.h"
#include "kestrel/app/web_server/test_browser.h"
#include "kestrel/core/base/error.h"

namespace kestrel {
namespace {

// The page of a study of three flights of which none can be opened; the error names the requested
// one.
class StudyConsoleTest : public testing::Test {
 protected:
  StudyConsoleTest() {
    study_.AddDone("calm", "usual", 9);
    study_.AddDone("calm", "strict", 9);
    study_.AddDone("gusts", "usual", 9, 0, "gusts.bag");
    study_.AddDone("gusts", "strict", 2, 0, "gusts.bag");
    study_.AddDone("dusk", "usual", 9);
    study_.AddFailed("dusk", "strict", "memory limit");
    StudyResults results(study_.path());
    std::vector<StudyVariant> variants = {{"usual", "v1", "land"}, {"strict", "v1", "land"}};
    ReplaySubject subject = SearchForPattern({}, LandingPipelineOptions(), {})->Subject();
    console_.emplace(AnyPort(), "study", std::move(results), variants, std::move(subject),
                     [](const std::string& path, const StudyVariant& variant,
                        const StudyOptions&) -> StudyConsole::Run {
                       throw InputError(path + " is not here for " + variant.configuration);
                     });
    thread_ = std::thread([this] { console_->Play([this] { return is_stopped_.load(); }); });
  }
  ~StudyConsoleTest() override {
    is_stopped_ = true;
    thread_.join();
  }
  int port() const {
    const std::string url = console_->urls().front();
    return std::stoi(url.substr(url.rfind(':') + 1));
  }

  TestFolder folder_;
  TestStudy study_{folder_};
  std::atomic<bool> is_stopped_{false};
  std::optional<StudyConsole> console_;
  std::thread thread_;
};

TEST_F(StudyConsoleTest, SendsTableWithWorstFirst) {
  TestSocket socket(port());
  const nlohmann::json study = socket.Await("study");
  EXPECT_EQ(study["variants"], (nlohmann::json{"usual", "strict"}));
  EXPECT_EQ(study["total"], 3);
  const nlohmann::json& rows = study["rows"];
  ASSERT_EQ(rows.size(), 3u);
  EXPECT_EQ(rows[0]["recording"], "dusk");
  EXPECT_EQ(rows[0]["after"]["failure"], "memory limit");
  EXPECT_EQ(rows[0]["change"], nullptr);
  EXPECT_EQ(rows[1]["recording"], "gusts");
  EXPECT_DOUBLE_EQ(rows[1]["before"]["found"], 0.9);
  EXPECT_NEAR(rows[1]["change"], -0.7, 1e-12);
  EXPECT_EQ(rows[2]["recording"], "calm");
}

TEST_F(StudyConsoleTest, ComparesInReverse) {
  TestSocket socket(port());
  ASSERT_EQ(socket.Await("study")["before"], 0);
  socket.Send(R"({"command": "compare", "settings": ["9", "0"]})");  // there is no such variant
  socket.Send(R"({"command": "compare", "settings": ["1", "0"]})");
  const nlohmann::json study = socket.Await("study");
  EXPECT_EQ(study["before"], 1);
  EXPECT_EQ(study["after"], 0);
  EXPECT_EQ(study["rows"][0]["recording"], "calm");
}

TEST_F(StudyConsoleTest, ReportsWhyRecordingCannotBeOpened) {
  TestSocket socket(port());
  socket.Await("study");
  socket.Send(R"({"command": "open", "value": 99})");  // there is no such row
  socket.Send(R"({"command": "open", "value": 1})");
  nlohmann::json replay = socket.Await("study-replay");
  while (replay["state"] == "none") replay = socket.Await("study-replay");
  EXPECT_EQ(replay["state"], "failed");
  EXPECT_EQ(replay["recording"], "gusts");
  EXPECT_EQ(replay["error"], "gusts.bag is not here for usual");
  // Nothing is played, so that there is nothing to export.
  TestBrowser browser(port());
  EXPECT_EQ(browser.Send(browser.Get("/export/frame-1.png")).result_int(), 404u);
}

TEST_F(StudyConsoleTest, ReportsMissingResults) {
  TestSocket socket(port());
  socket.Await("study");
  study_.Run("DROP TABLE bin");
  socket.Send(R"({"command": "compare", "settings": ["0", "1"]})");
  const nlohmann::json study = socket.Await("study");
  EXPECT_THAT(study["error"].get<std::string>(), testing::HasSubstr("no such table: bin"));
  EXPECT_TRUE(study["rows"].empty());
}

}  // namespace
}  // namespace kestrel
