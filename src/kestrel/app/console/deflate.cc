// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/app/console/deflate.h"

#include <new>
#include <zlib.h>

namespace kestrel {

std::string Deflate(std::string_view bytes) {
  uLongf size = compressBound(bytes.size());
  std::string deflated(size, '\0');
  const int status =
      compress2(reinterpret_cast<Bytef*>(deflated.data()), &size,
                reinterpret_cast<const Bytef*>(bytes.data()), bytes.size(), Z_BEST_SPEED);
  if (status != Z_OK) throw std::bad_alloc();
  deflated.resize(size);
  return deflated;
}

}  // namespace kestrel
