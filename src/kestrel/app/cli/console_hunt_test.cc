// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <string>

#include "kestrel/app/cli/test_running_command.h"
#include "kestrel/app/web_server/test_browser.h"

namespace kestrel {
namespace {

using ::testing::HasSubstr;
using ::testing::StartsWith;

class ConsoleHuntTest : public CommandTest {
 protected:
  // A short flight over objects, with truth.
  std::string Recording() const {
    return Simulate(
        "hunt", "--seed 4 --set frames=6 --set ground.map_px=512 --set shutter.rays_per_pixel=1");
  }
  static std::string Get(int port, const std::string& path) {
    TestBrowser browser(port);
    return browser.Send(browser.Get(path)).body();
  }
  // The table without the durations.
  static std::string WithoutTimes(const std::string& table) {
    return std::regex_replace(table, std::regex("(,[0-9]*),[0-9]+\\.[0-9]{4},"), "$1,,");
  }
};

TEST_F(ConsoleHuntTest, ReplaysHuntAndRunsItAgain) {
  const std::string flight = Recording();
  RunningCommand console("console --hunt " + flight + " --address 127.0.0.1:0", folder_);
  const int port = console.Port();
  TestSocket socket(port);
  const nlohmann::json hello = socket.Await("hello");
  EXPECT_THAT(hello["layers"].dump(), HasSubstr("truth"));
  EXPECT_EQ(hello["series"].back()["name"], "error");
  const nlohmann::json timeline = socket.Await("timeline");
  const std::string marks = timeline["marks"];
  ASSERT_EQ(marks.size(), 6u);
  ASSERT_NE(marks.find('f'), std::string::npos) << marks;
  // In a frame where everything was found, the page shows the errors of the detections.
  socket.Send(fmt::format(R"({{"command": "step", "value": {}}})", marks.find('f')));
  nlohmann::json findings = socket.Await("findings");
  while (findings["frame"] != marks.find('f')) findings = socket.Await("findings");
  EXPECT_THAT(findings["runs"][0].dump(), HasSubstr(" px"));
  // The picture of the frame before may still be on its way.
  std::string shapes = "[]";
  while (shapes == "[]") {
    socket.Send(R"({"images": true})");
    const nlohmann::json image = socket.Await("image");
    shapes = image["shapes"].dump();
    socket.Send(fmt::format(R"({{"ack": {}}})", image["sequence"].get<int>()));
  }
  EXPECT_THAT(shapes, HasSubstr("detection"));
  EXPECT_THAT(shapes, HasSubstr("truth"));
  // The command finds the same.
  const auto hunt = Run("hunt " + flight);
  EXPECT_EQ(WithoutTimes(Get(port, "/export/detections-1.csv")), WithoutTimes(hunt.out));
  // No segment is as large as this.
  socket.Send(R"({"command": "detect", "settings": ["hunt.detector.min_pixels=100000"]})");
  nlohmann::json second = socket.Await("second");
  while (second["state"] == "running") second = socket.Await("second");
  EXPECT_EQ(second["state"], "done") << second;
  const std::string others = second["marks"];
  EXPECT_EQ(others.find_first_of("fx"), std::string::npos) << others;
  EXPECT_NE(others.find('l'), std::string::npos) << others;
  EXPECT_EQ(console.End(), 0) << console.Log();
}

TEST_F(ConsoleHuntTest, ShowsResultOverItsRecording) {
  const std::string flight = Recording();
  const std::string result = folder_ / "result";
  Succeed("hunt " + flight + " --output " + result);
  // A run with these options would find nothing: the page shows the result.
  RunningCommand console("console --hunt " + flight + " " + result +
                             " --address 127.0.0.1:0 --set hunt.detector.min_pixels=100000",
                         folder_);
  const int port = console.Port();
  TestSocket socket(port);
  const nlohmann::json timeline = socket.Await("timeline");
  EXPECT_THAT(timeline["marks"].dump(), HasSubstr("f"));
  EXPECT_EQ(Get(port, "/export/detections-1.csv"), ReadFile(result + "/object_detections.csv"));
  EXPECT_EQ(console.End(), 0) << console.Log();
  ExpectInputError("console --hunt " + result, "is a result");
  const std::string table = ReadFile(result + "/object_detections.csv");
  const std::string header = table.substr(0, table.find('\n') + 1);
  const auto empty =
      Run("console --hunt --address 127.0.0.1:0 " + flight + " " + folder_.Write("a.csv", header));
  EXPECT_EQ(empty.status, 1);
  EXPECT_THAT(empty.err, HasSubstr("has no row of the recording's frame at"));
}

TEST_F(ConsoleHuntTest, ExportsClip) {
  RunningCommand console("console --hunt " + Recording() + " --address 127.0.0.1:0", folder_);
  const int port = console.Port();
  TestSocket socket(port);
  socket.Await("timeline");
  const std::string clip = Get(port, "/export/overlays-1-4.mp4");
  EXPECT_TRUE(clip.substr(4, 4) == "ftyp" || clip.starts_with("RIFF"));
  EXPECT_GT(clip.size(), 10'000u);
}

}  // namespace
}  // namespace kestrel
