// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/comms/mavlink/zoom_reports.h"

#include <cmath>

#include <gtest/gtest.h>

#include "kestrel/comms/mavlink/camera_messages.h"
#include "kestrel/comms/mavlink/test_autopilot.h"
#include "kestrel/core/geometry/angles.h"

namespace kestrel {
namespace {

constexpr int kCamera = 100;  // component

class ZoomOnLinkTest : public AutopilotTest {
 protected:
  void StartWithZoom(int device_id) {
    AutopilotOptions options;
    options.zoom_device_id = device_id;
    Start(options);
    Pass(5);
  }
  void SendView(double hfov_deg, int device_id, int component, std::uint32_t boot_ms) {
    mavlink::CameraFovStatus status;
    status.time_boot_ms = boot_ms;
    status.hfov = static_cast<float>(hfov_deg);
    status.camera_device_id = static_cast<std::uint8_t>(device_id);
    SendMessage(status, 1, component);
  }
  void SendStream(int hfov_deg) {
    mavlink::VideoStreamInformation stream;
    stream.hfov = static_cast<std::uint16_t>(hfov_deg);
    SendMessage(stream, 1, kCamera);
  }
};

TEST_F(ZoomOnLinkTest, RequestsAndConvertsReportsOfAutopilot) {
  StartWithZoom(0);
  EXPECT_EQ(intervals_us_[mavlink::CameraFovStatus::kId], 100000);
  SendView(41.5, 1, 1, BootMs());
  ASSERT_EQ(zoom_.size(), 1u);
  EXPECT_NEAR(ToSeconds(zoom_[0].time - now_), 0, 0.003);
  EXPECT_NEAR(Degrees(zoom_[0].view_rad), 41.5, 1e-5);
}

TEST_F(ZoomOnLinkTest, RequestsNothingWithoutZoom) {
  Start();
  Pass(5);
  EXPECT_EQ(intervals_us_.count(mavlink::CameraFovStatus::kId), 0u);
  SendView(41.5, 1, 1, BootMs());
  EXPECT_TRUE(zoom_.empty());
}

TEST_F(ZoomOnLinkTest, UsesOneOfSeveralCameras) {
  StartWithZoom(2);
  SendView(41.5, 1, 1, BootMs());
  SendView(20, 2, 1, BootMs());
  ASSERT_EQ(zoom_.size(), 1u);
  EXPECT_NEAR(Degrees(zoom_[0].view_rad), 20, 1e-5);
}

TEST_F(ZoomOnLinkTest, LearnsClockOfCameraThatIsComponent) {
  StartWithZoom(kCamera);
  constexpr std::uint32_t kOtherBoot_ms = 7'000'000;
  for (int i = 0; i < 100; ++i) {
    Pass(0.05);
    SendView(41.5, 0, kCamera, BootMs() - kOtherBoot_ms);
  }
  ASSERT_FALSE(zoom_.empty());
  EXPECT_NEAR(ToSeconds(zoom_.back().time - now_), 0, 0.02);
}

TEST_F(ZoomOnLinkTest, WholeDegreesCountUntilExactOnesCome) {
  StartWithZoom(0);
  SendStream(41);
  ASSERT_EQ(zoom_.size(), 1u);
  EXPECT_NEAR(Degrees(zoom_[0].view_rad), 41, 1e-9);
  for (int i = 0; i < 100; ++i) {
    Pass(0.05);
    SendView(41.5, 0, kCamera, BootMs());
  }
  const std::size_t exact = zoom_.size();
  EXPECT_GT(exact, 1u);
  SendStream(41);
  EXPECT_EQ(zoom_.size(), exact);
}

TEST_F(ZoomOnLinkTest, ReportWithoutViewIsIgnored) {
  StartWithZoom(0);
  SendStream(0);
  SendView(0, 1, 1, BootMs());
  SendView(std::nan(""), 1, 1, BootMs());
  EXPECT_TRUE(zoom_.empty());
}

}  // namespace
}  // namespace kestrel
