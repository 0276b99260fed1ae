// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <string>

namespace kestrel {

// Returns 'given', or else ROS_DOMAIN_ID, or else 0. Throws InputError when that is not a domain
// (0 to 232).
int DdsDomain(const std::optional<int>& given);

// Returns settings with which Cyclone DDS looks for others as ROS 2 does, from the environment:
// ROS_AUTOMATIC_DISCOVERY_RANGE (SUBNET, LOCALHOST, OFF, SYSTEM_DEFAULT), ROS_LOCALHOST_ONLY (1
// means LOCALHOST, and has priority) and ROS_STATIC_PEERS (addresses, separated by semicolons).
// Empty where these are not set. Throws InputError for other values.
std::string DiscoverySettings();

}  // namespace kestrel
