// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <memory>
#include <string>

#include "kestrel/app/web_server/temporary_folder.h"

namespace kestrel {

// A file on disk that is removed with its last owner.
struct ExportFile {
  TemporaryFolder folder;
  std::string path;
};

// A file that a page makes on request.
struct ExportAnswer {
  std::string content = {};  // empty: nothing, or it is in 'file'
  std::string type = {};     // as "image/png"
  std::string name = {};     // file name to save it as
  std::shared_ptr<const ExportFile> file = nullptr;
  std::string refusal = {};  // why it was not made; empty when the request is unknown
  std::string coding = {};   // coding of the content, as "deflate"
};

}  // namespace kestrel
