// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/comms/dds/dds_domain.h"

#include <cstdlib>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "kestrel/core/base/error.h"

namespace kestrel {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::Not;

class DdsDomainTest : public ::testing::Test {
 protected:
  DdsDomainTest() { Forget(); }
  ~DdsDomainTest() override { Forget(); }
  static void Forget() {
    for (const char* const name : {"ROS_DOMAIN_ID", "ROS_AUTOMATIC_DISCOVERY_RANGE",
                                   "ROS_LOCALHOST_ONLY", "ROS_STATIC_PEERS"}) {
      unsetenv(name);
    }
  }
  static void Set(const char* name, const char* value) { setenv(name, value, 1); }
};

TEST_F(DdsDomainTest, IsGivenDomainOrThatOfRos) {
  EXPECT_EQ(DdsDomain(std::nullopt), 0);
  Set("ROS_DOMAIN_ID", "42");
  EXPECT_EQ(DdsDomain(std::nullopt), 42);
  EXPECT_EQ(DdsDomain(7), 7);
  EXPECT_THROW(DdsDomain(233), InputError);
  EXPECT_THROW(DdsDomain(-1), InputError);
  for (const char* const wrong : {"233", "-1", "3.5", "mine"}) {
    Set("ROS_DOMAIN_ID", wrong);
    EXPECT_THROW(DdsDomain(std::nullopt), InputError) << wrong;
  }
}

TEST_F(DdsDomainTest, DiscoversPeersLikeRos) {
  EXPECT_THAT(DiscoverySettings(), IsEmpty());
  Set("ROS_AUTOMATIC_DISCOVERY_RANGE", "SUBNET");
  EXPECT_THAT(DiscoverySettings(), IsEmpty());
  Set("ROS_STATIC_PEERS", "10.0.0.1;uav-2.local;");
  EXPECT_THAT(DiscoverySettings(),
              AllOf(HasSubstr("\"10.0.0.1\""), HasSubstr("\"uav-2.local\""),
                    HasSubstr("<ParticipantIndex>auto"), Not(HasSubstr("AllowMulticast"))));
  Set("ROS_AUTOMATIC_DISCOVERY_RANGE", "LOCALHOST");
  EXPECT_THAT(DiscoverySettings(), AllOf(HasSubstr("<AllowMulticast>false"),
                                         HasSubstr("\"localhost\""), HasSubstr("10.0.0.1")));
  Set("ROS_AUTOMATIC_DISCOVERY_RANGE", "OFF");
  EXPECT_THAT(DiscoverySettings(), AllOf(HasSubstr("<Tag>"), Not(HasSubstr("10.0.0.1"))));
  Set("ROS_LOCALHOST_ONLY", "1");
  EXPECT_THAT(DiscoverySettings(), AllOf(HasSubstr("\"localhost\""), Not(HasSubstr("<Tag>"))));
}

TEST_F(DdsDomainTest, ReportsWrongVariables) {
  Set("ROS_AUTOMATIC_DISCOVERY_RANGE", "FAR");
  EXPECT_THROW(DiscoverySettings(), InputError);
  Set("ROS_AUTOMATIC_DISCOVERY_RANGE", "SUBNET");
  Set("ROS_STATIC_PEERS", "10.0.0.1\"/><Tracing>");
  EXPECT_THROW(DiscoverySettings(), InputError);
}

}  // namespace
}  // namespace kestrel
