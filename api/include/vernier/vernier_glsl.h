/* Vernier's GLSL compiler: GLSL source text in, SPIR-V words out. C99; link with vernier_glsl.
 *
 * The rules are those of GL_KHR_vulkan_glsl, the input is `#version 450` or what the source itself asks for.
 * All functions may be called from any thread at any time. */
#ifndef VERNIER_VERNIER_GLSL_H_
#define VERNIER_VERNIER_GLSL_H_

#include <stddef.h>
#include <stdint.h>
#include <vulkan/vulkan_core.h>

#ifdef __cplusplus
extern "C" {
#endif

#if defined(__GNUC__)
#define VN_GLSL_API __attribute__((visibility("default")))
#else
#define VN_GLSL_API
#endif

/** What a call came to. Zero is success, errors are negative. */
typedef enum VnGlslResult {
    VN_GLSL_SUCCESS = 0,
    /** The description is not usable as it stands; the output's log names the field. */
    VN_GLSL_ERROR_INVALID_ARGUMENT = -1,
    /** The source was refused; the output's log has the messages with their line numbers. */
    VN_GLSL_ERROR_COMPILE_FAILED = -2,
    /** Memory ran out; there is no output. */
    VN_GLSL_ERROR_OUT_OF_MEMORY = -3,
    VN_GLSL_RESULT_MAX_ENUM = 0x7FFFFFFF
} VnGlslResult;

/** The environment whose rules the module obeys. */
typedef enum VnGlslTarget {
    /** The same as VN_GLSL_TARGET_VULKAN_1_1. */
    VN_GLSL_TARGET_DEFAULT = 0,
    /** Vulkan 1.0, SPIR-V 1.0. */
    VN_GLSL_TARGET_VULKAN_1_0 = 1,
    /** Vulkan 1.1, SPIR-V 1.3. */
    VN_GLSL_TARGET_VULKAN_1_1 = 2,
    /** Vulkan 1.2, SPIR-V 1.5. */
    VN_GLSL_TARGET_VULKAN_1_2 = 3,
    /** Vulkan 1.3, SPIR-V 1.6. */
    VN_GLSL_TARGET_VULKAN_1_3 = 4,
    VN_GLSL_TARGET_MAX_ENUM = 0x7FFFFFFF
} VnGlslTarget;

/** What to compile. Zero-initialise it, then set `stage` and `source`: zero in every other field means its
 * default. */
typedef struct VnGlslDesc {
    /** Exactly one of VERTEX, TESSELLATION_CONTROL, TESSELLATION_EVALUATION, GEOMETRY, FRAGMENT and COMPUTE.
     */
    VkShaderStageFlagBits stage;
    /** The source text, UTF-8. Not kept after the call. */
    const char* source;
    /** Length of `source` in bytes; 0: it ends at its first zero byte. */
    size_t sourceLength;
    /** Name of the source in messages and debug information, zero-terminated; NULL: none. */
    const char* sourceName;
    /** Name under which the module exports the source's main(), zero-terminated; NULL: "main". */
    const char* entryName;
    /** Environment to generate for. */
    VnGlslTarget target;
    /** Not 0: keep names, source text and line numbers in the module (OpSource, OpLine). 0: leave them out.
     */
    uint32_t debugInfo;
} VnGlslDesc;

/** What came of it. Owned by the library; read only; gone after vnFreeGlslOutput(). */
typedef struct VnGlslOutput {
    /** The SPIR-V module in host byte order; NULL unless the call succeeded. */
    const uint32_t* words;
    /** Number of elements of `words`. */
    size_t wordCount;
    /** Zero-terminated messages, one a line, as "ERROR: name:line: text" (or WARNING); never NULL, empty if
     * there are none. Warnings may accompany success. */
    const char* log;
} VnGlslOutput;

/** Compiles one shader stage.
 *
 * Stores an output in `*out` to be freed with vnFreeGlslOutput(), on success and on failure (for its log),
 * except when out of memory: then `*out` is NULL. `desc` and `out` must not be NULL
 * (VN_GLSL_ERROR_INVALID_ARGUMENT). */
VN_GLSL_API VnGlslResult vnCompileGlsl(const VnGlslDesc* desc, VnGlslOutput** out);

/** Frees an output; NULL is allowed. */
VN_GLSL_API void vnFreeGlslOutput(VnGlslOutput* output);

/** Keeps the compiler's tables in memory until the matching vnReleaseGlslCompiler(), so that the calls in
 * between need not build them anew (tens of milliseconds each). Calls nest and may come from several threads.
 * Optional. */
VN_GLSL_API VnGlslResult vnRetainGlslCompiler(void);

/** Undoes one vnRetainGlslCompiler(). A call without a match does nothing. */
VN_GLSL_API void vnReleaseGlslCompiler(void);

#ifdef __cplusplus
}
#endif

#endif /* VERNIER_VERNIER_GLSL_H_ */
