// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/app/ros_node/node_parameters.h"

#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "kestrel/core/base/error.h"
#include "kestrel/core/base/test_folder.h"

namespace kestrel {
namespace {

using ::testing::HasSubstr;

// The error of these parameters; empty without one.
std::string ErrorOf(const NodeParameters& parameters) {
  try {
    ReadNodeOptions(parameters);
    return "";
  } catch (const InputError& error) {
    return error.what();
  }
}

TEST(NodeParameters, NameTheOptionsOfTheConfigurationAndOfTheNode) {
  const NodeOptions options = ReadNodeOptions({{"landing.detector.min_quality", "0.6"},
                                               {"fly.events.pose_wait_s", "0.1"},
                                               {"altitude_m", "5"}});
  EXPECT_EQ(options.landing.detector.min_quality, 0.6);
  EXPECT_EQ(options.fly.events.pose_wait_s, 0.1);
  EXPECT_EQ(options.altitude_m, 5);
}

TEST(NodeParameters, AFileOfOptionsIsReadBeforeTheParameters) {
  const TestFolder folder;
  const std::string file =
      folder.Write("options.yaml", "hunt:\n  detector:\n    min_pixels: 7\nteam:\n  uav: falcon\n");
  EXPECT_EQ(ReadNodeOptions({{"config", file}}).hunt.detector.min_pixels, 7);
  EXPECT_EQ(ReadNodeOptions({{"hunt.detector.min_pixels", "8"}, {"config", file}})
                .hunt.detector.min_pixels,
            8);
  folder.Write("options.yaml", "hunt: [");
  EXPECT_THAT(ErrorOf({{"config", file}}), HasSubstr("options.yaml"));
}

TEST(NodeParameters, OptionsOfTheCommandsAloneHaveNoEffect) {
  EXPECT_EQ(ErrorOf({{"fly.sim_seed", "5"}, {"console.port", "1"}, {"dds.node", "b"}}), "");
}

TEST(NodeParameters, AMisspeltOptionOfAnyGroupNamesTheNearest) {
  const TestFolder folder;
  for (const std::string key : {"fly.events.pose_wait", "fly.sim_sed", "console.prt", "team.uaw",
                                "dds.nod", "landing.detector.min_qualty", "tusk"}) {
    EXPECT_THAT(ErrorOf({{key, "1"}}), HasSubstr("unknown key '" + key + "', did you mean '"));
  }
  const std::string file = folder.Write("options.yaml", "team:\n  uaw: falcon\n");
  EXPECT_THAT(ErrorOf({{"config", file}}),
              HasSubstr("options.yaml:2: unknown key 'team.uaw', did you mean 'team.uav'?"));
}

TEST(NodeParameters, ValuesThatCannotBeAreNamed) {
  for (const auto& [key, value] : NodeParameters{{"poses", "gps"},
                                                 {"task", "fly"},
                                                 {"origin", "50.1"},
                                                 {"origin", "95,14"},
                                                 {"console.port", "high"}}) {
    EXPECT_THAT(ErrorOf({{key, value}}), HasSubstr(key)) << value;
  }
  EXPECT_THAT(ErrorOf({{"altitude_m", "1500"}}),
              HasSubstr("altitude_m is 1500, expected metres: 1.5?"));
}

}  // namespace
}  // namespace kestrel
