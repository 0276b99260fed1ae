// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

namespace kestrel {

using TeamKey = std::array<std::uint8_t, 32>;
inline constexpr std::size_t kSignatureSize = 16;

// Puts the signature by a key that the team shares behind the bytes: the first 16 bytes of
// HMAC-SHA-256 (RFC 2104). A message that is played again is an old one, which changes nothing.
void SignMessage(const TeamKey& key, std::vector<std::uint8_t>* bytes);

// The bytes without their signature; nothing when it is not there or not by this key.
std::optional<std::span<const std::uint8_t>> CheckSignature(const TeamKey& key,
                                                            std::span<const std::uint8_t> bytes);

}  // namespace kestrel
