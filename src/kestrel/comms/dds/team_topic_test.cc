// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/comms/dds/team_topic.h"

#include <chrono>
#include <dds/dds.h>
#include <string>
#include <sys/wait.h>
#include <unistd.h>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "kestrel/comms/dds/test_dds.h"
#include "kestrel/comms/team/team_member.h"
#include "kestrel/core/base/error.h"
#include "kestrel/core/base/test_eventually.h"
#include "kestrel/core/base/time.h"

namespace kestrel {
namespace {

// Takes part until 'count' UAVs are known and nothing is missing; false if that does not come. A
// UAV that is done stays for the others.
bool TakePart(int domain, const std::string& name, std::size_t count) {
  const UavKey self{name, 1};
  TeamTopic topic(domain, "test", name);
  TeamMember member(self, {});
  MappedObject object;
  object.covariance.diagonal().head<3>().setConstant(0.01);
  member.Share({object}, Time());
  std::optional<Time> done;
  return Eventually([&] {
    topic.Receive([&](std::span<const std::uint8_t> bytes) { member.Hear(bytes, Now()); });
    member.Tick(Now(), [&](std::span<const std::uint8_t> bytes) { topic.Send(bytes); });
    if (!done && member.map().parts().size() == count && member.IsWhole()) done = Now();
    return done && Now() - *done > std::chrono::seconds(1);
  });
}

TEST(TeamTopic, ThreeProcessesShareMaps) {
  const int domain = TestDomain();
  for (const char* name : {"b", "c"}) {
    if (fork() == 0) _exit(TakePart(domain, name, 3) ? 0 : 1);
  }
  EXPECT_TRUE(TakePart(domain, "a", 3));
  for (int i = 0; i < 2; ++i) {
    int status = 1;
    wait(&status);
    EXPECT_EQ(status, 0);
  }
}

// The name that docs/team.md gives to other programs.
TEST(TeamTopic, HasDocumentedName) {
  const int domain = TestDomain();
  const TeamTopic topic(domain, "test", "a");
  const dds_entity_t participant =
      dds_create_participant(static_cast<dds_domainid_t>(domain), nullptr, nullptr);
  const dds_entity_t reader =
      dds_create_reader(participant, DDS_BUILTIN_TOPIC_DCPSPUBLICATION, nullptr, nullptr);
  void* sample = nullptr;
  dds_sample_info_t info{};
  ASSERT_EQ(dds_take(reader, &sample, &info, 1, 1), 1);
  EXPECT_STREQ(static_cast<dds_builtintopic_endpoint_t*>(sample)->topic_name, "kestrel/team/test");
  dds_return_loan(reader, &sample, 1);
  dds_delete(participant);
}

TEST(TeamTopic, ChecksDomains) {
  EXPECT_THROW(TeamTopic(-1, "test", "a"), InputError);
  EXPECT_THROW(TeamTopic(233, "test", "a"), InputError);
}

}  // namespace
}  // namespace kestrel
