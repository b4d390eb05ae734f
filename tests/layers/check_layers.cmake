# Fails when a source file includes a header of a room that its own room may not know: see docs/architecture.md. A room is
# a folder of two levels if it is listed below, else of one. Only includes with quotes count: those are ours.
#   cmake -DROOT=<repository> -P check_layers.cmake
cmake_minimum_required(VERSION 3.25)

macro(room name)
    set(may_${name} "${ARGN}")
endmacro()

room(base)
room(spirv_interp/ir base)
room(spirv_interp base spirv_interp/ir)
room(spirv_interp/front base spirv_interp spirv_interp/ir)
room(spirv_interp/batch base spirv_interp spirv_interp/ir)
# The reference shares nothing with the engine, so that it can judge it.
room(spirv_interp/reference base)
room(spirv_interp/tool base spirv_interp spirv_interp/ir spirv_interp/front spirv_interp/reference api/include)

room(runtime base spirv_interp)
room(runtime/format base)
room(runtime/texture base runtime/format)
room(runtime/resource base spirv_interp runtime runtime/format runtime/texture)
room(runtime/plan base spirv_interp spirv_interp/ir runtime runtime/format runtime/texture runtime/resource)
room(runtime/geometry base spirv_interp runtime runtime/format runtime/plan)
room(runtime/raster base spirv_interp runtime runtime/format runtime/plan runtime/geometry)
room(runtime/transfer base runtime runtime/format runtime/resource)
room(runtime/command base spirv_interp runtime runtime/format runtime/resource runtime/plan runtime/geometry runtime/raster
    runtime/transfer)

room(api/include)
room(api/glsl api/include)
foreach(front mini vulkan)
    room(api/${front} base spirv_interp runtime runtime/format runtime/texture runtime/resource runtime/plan
        runtime/geometry runtime/raster runtime/transfer runtime/command api/include)
endforeach()

room(conformance/scene base)
room(conformance/scenes base conformance/scene)
# What judges the renderer uses nothing of it.
room(conformance/oracle base spirv_interp/reference conformance/scene conformance/scenes)
room(conformance/differ base conformance/scene conformance/oracle)
room(conformance/drivers base conformance/scene api/include)
room(conformance/report base conformance/scene conformance/oracle conformance/differ conformance/drivers)
room(conformance/tool base conformance/scene conformance/scenes conformance/oracle conformance/differ conformance/drivers
    conformance/report)
room(conformance/hardcases base spirv_interp/reference conformance/scene conformance/scenes conformance/oracle conformance/differ
    conformance/drivers conformance/report conformance/tool)
room(conformance/precision base spirv_interp spirv_interp/reference conformance/drivers api/include)

# Above all of these stand bench and tests, which may know everything.
room(samples api/include)

function(room_of path out)
    string(REGEX MATCH "^[^/]+/[^/]+" two "${path}")
    string(REGEX MATCH "^[^/]+" one "${path}")
    if(DEFINED may_${two})
        set(${out} ${two} PARENT_SCOPE)
    elseif(DEFINED may_${one} AND path MATCHES "/")
        set(${out} ${one} PARENT_SCOPE)
    else()
        set(${out} "" PARENT_SCOPE)
    endif()
endfunction()

set(wrong "")
set(count 0)
foreach(top base spirv_interp runtime api conformance samples)
    file(GLOB_RECURSE files RELATIVE ${ROOT} ${ROOT}/${top}/*.cpp ${ROOT}/${top}/*.h ${ROOT}/${top}/*.c ${ROOT}/${top}/*.def)
    foreach(file IN LISTS files)
        room_of("${file}" from)
        if(NOT from)
            string(APPEND wrong "${file} is in no room\n")
            continue()
        endif()
        file(STRINGS ${ROOT}/${file} lines REGEX "^#include \"")
        foreach(line IN LISTS lines)
            string(REGEX REPLACE "^#include \"([^\"]+)\".*" "\\1" header "${line}")
            room_of("${header}" to)
            math(EXPR count "${count} + 1")
            # Headers without a room are made by the build (entry_points.inc, ...).
            if(to AND NOT to STREQUAL from AND NOT to IN_LIST may_${from})
                string(APPEND wrong "${file} includes ${header}: ${from} may not know ${to}\n")
            endif()
        endforeach()
        if(from STREQUAL "conformance/oracle")
            file(STRINGS ${ROOT}/${file} api REGEX "^#include <vernier/")
            if(api)
                string(APPEND wrong "${file} includes the API: ${api}\n")
            endif()
        endif()
    endforeach()
endforeach()
if(count LESS 500)
    message(FATAL_ERROR "only ${count} includes seen below ${ROOT}: nothing was checked")
endif()
if(wrong)
    message(FATAL_ERROR "Arrows that do not point down:\n${wrong}")
endif()
message(STATUS "${count} includes point down")
