// The Vulkan headers that this library implements, window systems included, without the window systems' own headers:
// the few opaque types that their declarations name are declared here.
#pragma once

#include <cstdint>

extern "C" {
typedef struct xcb_connection_t xcb_connection_t;
typedef std::uint32_t xcb_window_t;
typedef std::uint32_t xcb_visualid_t;
typedef struct _XDisplay Display;
typedef unsigned long Window;
typedef unsigned long VisualID;
}

#include <vulkan/vulkan_core.h>

#include <vulkan/vulkan_wayland.h>
#include <vulkan/vulkan_xcb.h>
#include <vulkan/vulkan_xlib.h>

static_assert(sizeof(void*) == 8, "handles are pointers");
