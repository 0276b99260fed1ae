# Writes OUTPUT, the C++ source of WebAssets(): the files of FOLDER, and PLAIN_PAGE as /index.html
# where the folder has none.
#
#   cmake -DFOLDER=web/dist -DPLAIN_PAGE=plain_page.html -DOUTPUT=web_assets.cc -P EmbedWebAssets.cmake
#
# web/'s build gzips its files; a name that ends in .gz is served without it.
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
macro(embed file path)
  file(READ ${file} bytes HEX)
  string(REGEX REPLACE "(..)" "0x\\1," bytes "${bytes}")
  string(REGEX REPLACE "(................................................................................)" "\\1\n"
                       bytes "${bytes}")
  set(is_gzipped false)
  if(${file} MATCHES "\\.gz$")
    set(is_gzipped true)
  endif()
  web_type(${path} type)
  string(APPEND arrays "constexpr unsigned char kFile${count}[] = {\n${bytes}};\n")
  string(APPEND entries
         "    {\"${path}\", \"${type}\", Content(kFile${count}), ${is_gzipped}},\n")
  math(EXPR count "${count} + 1")
endmacro()

set(files "")
if(FOLDER AND EXISTS ${FOLDER}/index.html.gz)
  file(GLOB_RECURSE files ${FOLDER}/*.gz)
  list(SORT files)
endif()
foreach(file IN LISTS files)
  file(RELATIVE_PATH name ${FOLDER} ${file})
  string(REGEX REPLACE "\\.gz$" "" name ${name})
  embed(${file} "/${name}")
endforeach()
if(NOT files)
  embed(${PLAIN_PAGE} "/index.html")
endif()

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
