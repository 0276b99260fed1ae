// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/comms/team/message_signature.h"

#include <nettle/hmac.h>
#include <nettle/memops.h>

namespace kestrel {
namespace {

using Signature = std::array<std::uint8_t, kSignatureSize>;

Signature SignatureOf(const TeamKey& key, std::span<const std::uint8_t> bytes) {
  hmac_sha256_ctx context;
  hmac_sha256_set_key(&context, key.size(), key.data());
  hmac_sha256_update(&context, bytes.size(), bytes.data());
  Signature signature;
  hmac_sha256_digest(&context, signature.size(), signature.data());
  return signature;
}

}  // namespace

void SignMessage(const TeamKey& key, std::vector<std::uint8_t>* bytes) {
  const Signature signature = SignatureOf(key, *bytes);
  bytes->insert(bytes->end(), signature.begin(), signature.end());
}

std::optional<std::span<const std::uint8_t>> CheckSignature(const TeamKey& key,
                                                            std::span<const std::uint8_t> bytes) {
  if (bytes.size() < kSignatureSize) return std::nullopt;
  const auto content = bytes.first(bytes.size() - kSignatureSize);
  const Signature signature = SignatureOf(key, content);
  if (nettle_memeql_sec(signature.data(), bytes.last(kSignatureSize).data(), kSignatureSize) == 0) {
    return std::nullopt;
  }
  return content;
}

}  // namespace kestrel
