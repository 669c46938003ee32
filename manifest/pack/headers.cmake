# Vulkan's and SPIR-V's headers and the registry that the generators read: those that manifest/pack/newer-headers has
# unpacked, where they are there and the installed ones are not asked for, else the installed ones. All that is built takes
# the same. Nothing is fetched here.
set(VITRINE_HEADERS "$ENV{VITRINE_HEADERS}" CACHE STRING "system: the installed headers; empty or newer: unpacked ones, where they are")
if(NOT VITRINE_HEADERS MATCHES "^(newer|system)?$")
  message(FATAL_ERROR "VITRINE_HEADERS is \"${VITRINE_HEADERS}\", neither \"newer\" nor \"system\"")
endif()
file(GLOB newer_headers CONFIGURE_DEPENDS ${CMAKE_SOURCE_DIR}/build/headers/complete)
if(newer_headers AND NOT VITRINE_HEADERS STREQUAL "system")
  set(VITRINE_HEADERS_ROOT ${CMAKE_SOURCE_DIR}/build/headers/usr)
  include_directories(BEFORE SYSTEM ${VITRINE_HEADERS_ROOT}/include)
  set(VITRINE_VK_XML ${VITRINE_HEADERS_ROOT}/share/vulkan/registry/vk.xml)
else()
  unset(VITRINE_HEADERS_ROOT CACHE)
  find_file(VITRINE_VK_XML vk.xml PATHS /usr/share/vulkan/registry /usr/local/share/vulkan/registry REQUIRED)
  if(VITRINE_HEADERS STREQUAL "newer")
    message(STATUS "Newer headers are not there (manifest/pack/newer-headers build/headers unpacks them)")
  endif()
endif()
message(STATUS "Vulkan's registry: ${VITRINE_VK_XML}")
# For ./package, which tells what is inside.
set(VITRINE_HEADERS_ROOT "${VITRINE_HEADERS_ROOT}" CACHE INTERNAL "Folder of the unpacked headers; empty: the system's are taken")
