# Writes OUTPUT, the C++ source of WebAssets(): the files of FOLDER, gzipped.
#
#   cmake -DFOLDER=web/page -DOUTPUT=web_assets.cc -P EmbedWebAssets.cmake
cmake_minimum_required(VERSION 3.22)

function(web_type name result)
  if(name MATCHES "\\.html$")
    set(type "text/html; charset=utf-8")
  elseif(name MATCHES "\\.js$")
    set(type "text/javascript; charset=utf-8")
  elseif(name MATCHES "\\.css$")
    set(type "text/css; charset=utf-8")
  elseif(name MATCHES "\\.svg$")
    set(type "image/svg+xml")
  else()
    set(type "application/octet-stream")
  endif()
  set(${result} "${type}" PARENT_SCOPE)
endfunction()

set(arrays "")
set(entries "")
set(count 0)
file(GLOB_RECURSE files ${FOLDER}/*)
list(SORT files)
foreach(file IN LISTS files)
  file(RELATIVE_PATH path ${FOLDER} ${file})
  execute_process(COMMAND gzip -9nc ${file} OUTPUT_FILE ${OUTPUT}.gz COMMAND_ERROR_IS_FATAL ANY)
  file(READ ${OUTPUT}.gz bytes HEX)
  string(REGEX REPLACE "(..)" "0x\\1," bytes "${bytes}")
  string(REGEX REPLACE "(................................................................................)" "\\1\n"
                       bytes "${bytes}")
  web_type(${path} type)
  string(APPEND arrays "constexpr unsigned char kFile${count}[] = {\n${bytes}};\n")
  string(APPEND entries "    {\"/${path}\", \"${type}\", Content(kFile${count}), true},\n")
  math(EXPR count "${count} + 1")
endforeach()
file(REMOVE ${OUTPUT}.gz)

file(WRITE ${OUTPUT}.new "// Made by cmake/EmbedWebAssets.cmake.
#include \"kestrel/app/console/web_assets.h\"

namespace kestrel {
namespace {

${arrays}
template <std::size_t size>
std::string_view Content(const unsigned char (&bytes)[size]) {
  return {reinterpret_cast<const char*>(bytes), size};
}

}  // namespace

std::span<const WebAsset> WebAssets() {
  static const WebAsset kAssets[] = {
${entries}  };
  return kAssets;
}

}  // namespace kestrel
")
file(COPY_FILE ${OUTPUT}.new ${OUTPUT} ONLY_IF_DIFFERENT)
file(REMOVE ${OUTPUT}.new)
