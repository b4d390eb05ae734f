// The window systems' part of Vulkan's headers. Xlib's own header defines macros with names such as Status and None:
// the three types that Vulkan needs of it are declared here instead, as Xlib declares them.
#pragma once

#include <vulkan/vulkan_core.h>
#include <xcb/xcb.h>

#include <vulkan/vulkan_xcb.h>

struct _XDisplay;
typedef struct _XDisplay Display;
typedef unsigned long Window;
typedef unsigned long VisualID;

#include <vulkan/vulkan_wayland.h>
#include <vulkan/vulkan_xlib.h>
