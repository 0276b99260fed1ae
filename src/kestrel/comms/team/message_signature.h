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

// Appends the signature by the team's shared key to the bytes: the first 16 bytes of HMAC-SHA-256
// (RFC 2104). A replayed message is an old one, which changes nothing.
void SignMessage(const TeamKey& key, std::vector<std::uint8_t>* bytes);

// Returns the bytes without their signature; nothing when it is missing or not by this key.
std::optional<std::span<const std::uint8_t>> CheckSignature(const TeamKey& key,
                                                            std::span<const std::uint8_t> bytes);

}  // namespace kestrel
