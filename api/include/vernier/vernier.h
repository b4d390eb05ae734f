/* clang-format off */
/* Vernier: a software GPU with a small C API.
 *
 *   VnDevice device;  vnCreateDevice(NULL, &device);
 *   VnContext context; vnCreateContext(device, NULL, &context);
 *   ... create buffers, images, a program, state objects ...
 *   vnBeginPass(context, &pass); vnBindProgram(context, program); vnDraw(context, 3, 1, 0, 0); vnEndPass(context);
 *   vnReadImage(context, image, NULL, pixels, sizeof pixels);
 *
 * How it is used:
 *  - A *device* owns all objects. A *context* records commands and looks immediate: commands take effect in the order of
 *    the calls; work runs in the background from vnFlush on, and every function that hands data back waits for it.
 *  - *State objects* (vertex layout, raster, depth-stencil, blend, program) are immutable and cheap to bind. Each
 *    combination that is drawn with is planned once and cached. Viewports, scissors, topology, blend constants and the
 *    stencil reference are set directly.
 *  - Resources are bound by (set, binding) as the shaders declare them and may be changed between any two draws or
 *    dispatches.
 *  - Every descriptor struct may be zero-initialised: zero means the default, told at each field. `_start` and `_end`
 *    must be 0: they catch structs that were never initialised (VN_ERROR_INVALID_ARGUMENT).
 *  - Conventions are Vulkan's: clip space with y down and depth 0..1, framebuffer origin at the top left, SPIR-V shaders,
 *    Vulkan's enums. A viewport of negative height turns y up.
 *
 * Errors: every function that can fail returns a VnResult; on failure nothing has changed, vnGetError tells in words what
 * was wrong, naming the object, the field and the value, and the device goes on working. A NULL or destroyed handle is an
 * error, never a crash (but a VnDevice or VnContext is a pointer: do not use it after its destruction). A failed command
 * in a context is skipped.
 *
 * Threads: functions that take a VnDevice may be called from any thread at any time, except vnDestroyDevice. A context
 * is used by one thread at a time; several contexts of a device may be used by several threads. Destroying an object that
 * recorded or running commands still use is allowed: it lives on until they are done.
 *
 * C99 and C++. Nothing global: several devices live side by side.
 */
/* clang-format on */
#ifndef VERNIER_H
#define VERNIER_H

#include <stddef.h>
#include <stdint.h>
#include <vulkan/vulkan_core.h>

#ifdef __cplusplus
extern "C" {
#endif

#if defined(__GNUC__)
#define VN_API __attribute__((visibility("default")))
#else
#define VN_API
#endif

#define VN_VERSION_MAJOR 0
#define VN_VERSION_MINOR 1
#define VN_VERSION_PATCH 0

/* ---- Results and messages ---- */

typedef enum VnResult {
    VN_SUCCESS = 0,
    VN_ERROR_INVALID_ARGUMENT = -1, /* a rule of this header was broken */
    VN_ERROR_INVALID_HANDLE = -2,   /* NULL, destroyed, or of another device */
    VN_ERROR_INVALID_STATE = -3,    /* e.g. a draw outside a pass, or without a program */
    VN_ERROR_UNSUPPORTED = -4,      /* legal, but not implemented; the message names the feature */
    VN_ERROR_SHADER = -5,           /* the SPIR-V is broken or does not fit the other state */
    VN_ERROR_OUT_OF_MEMORY = -6,
    VN_ERROR_DEVICE_LOST =
        -7 /* a shader looped beyond the budget, or memory ran out while work ran: nothing more runs */
} VnResult;

typedef enum VnSeverity { VN_SEVERITY_INFO = 0, VN_SEVERITY_WARNING = 1, VN_SEVERITY_ERROR = 2 } VnSeverity;

/* Called on the thread whose call caused the message, with a zero-terminated UTF-8 text that lives during the call. It
 * must not call back into Vernier. */
typedef void (*VnMessageCallback)(void* user, VnSeverity severity, const char* text);

/* ---- Handles: typed, by value; {0} is no object ---- */

typedef struct VnDevice_T* VnDevice;
typedef struct VnContext_T* VnContext;
#define VN_HANDLE(Name)   \
    typedef struct Name { \
        uint64_t id;      \
    } Name
VN_HANDLE(VnBuffer);
VN_HANDLE(VnImage);
VN_HANDLE(VnView);
VN_HANDLE(VnSampler);
VN_HANDLE(VnShader);
VN_HANDLE(VnProgram);
VN_HANDLE(VnVertexLayout);
VN_HANDLE(VnRasterState);
VN_HANDLE(VnDepthStencilState);
VN_HANDLE(VnBlendState);
VN_HANDLE(VnQuery);
#undef VN_HANDLE

/* ---- Accuracy ---- */

/* One ordered dial. Watertightness, drawing order, determinism and memory safety hold at every position. Results at
 * VN_PROFILE_STANDARD and above do not depend on the number of threads, the SIMD width or the CPU. Each axis of it can
 * be set alone, too, by name, and chosen by a budget of time or error: vernier_accuracy.h. */
typedef enum VnProfile {
    VN_PROFILE_DEFAULT = 0,  /* VN_PROFILE_STANDARD */
    VN_PROFILE_DRAFT = 1,    /* below Vulkan's minimum */
    VN_PROFILE_FAST = 2,     /* below it in the elementary functions of shaders */
    VN_PROFILE_STANDARD = 3, /* what Vulkan asks for, or better */
    VN_PROFILE_FINE = 4,
    VN_PROFILE_REFERENCE = 5
} VnProfile;

/* ---- Device ---- */

/* Where big allocations (buffers, images) come from. Both functions must be thread-safe. */
typedef struct VnAllocator {
    void* user;
    /* `bytes` of memory aligned to `alignment` (a power of two, at most 64), or NULL. */
    void* (*allocate)(void* user, size_t bytes, size_t alignment);
    void (*release)(void* user, void* memory, size_t bytes);
} VnAllocator;

typedef struct VnDeviceDesc {
    uint32_t _start;
    uint32_t threads;  /* worker threads, the background thread included; 0: one per usable CPU (affinity mask and
                          cgroup quota); at most 256 */
    VnProfile profile; /* of programs that do not choose their own */
    const char* axes;  /* NULL, or the axes to change in that profile: "axis=position ..." */
    VnMessageCallback message; /* NULL: none. Also gets warnings */
    void* messageUser;
    VnAllocator allocator; /* both functions NULL: the C++ heap */
    const char* maxIsa;    /* NULL: the best of this CPU; "sse4", "avx2", "avx512" (Arm: "neon") limit it, for tests */
    const char* skips;     /* NULL or "on": what draws do not need is left out. "off": it is done all the same, with the
                              same pictures (to see what it would cost). "hidden_work=off ...": one rule alone; an
                              unknown name's error lists them */
    uint32_t _end;
} VnDeviceDesc;

/* `desc` may be NULL (all defaults). There is no device to ask for an error text yet: the message callback gets it. */
VN_API VnResult vnCreateDevice(const VnDeviceDesc* desc, VnDevice* device);
/* Waits for running work, then destroys the device with everything in it, contexts included. NULL is allowed. */
VN_API void vnDestroyDevice(VnDevice device);
/* Copies the text of the last error of this device, zero-terminated and cut to `capacity` bytes, and returns its full
 * length without the zero. "" when nothing has failed. `text` may be NULL when `capacity` is 0. */
VN_API size_t vnGetError(VnDevice device, char* text, size_t capacity);

typedef struct VnDeviceInfo {
    const char* version; /* "0.1.0" */
    const char* isa;     /* "sse4", "avx2" or "avx512"; Arm: "neon" */
    uint32_t threads;
    uint32_t maxImageSize; /* texels on a side */
    uint32_t maxSamples;
    uint32_t maxColorAttachments;
    uint32_t maxVertexAttributes;
    uint32_t subPixelBits; /* of the device's profile */
} VnDeviceInfo;
VN_API VnResult vnGetDeviceInfo(VnDevice device, VnDeviceInfo* info);

/* What `format` can be used for, as VkFormatFeatureFlags; 0 for an unknown one. */
VN_API VkFormatFeatureFlags vnGetFormatFeatures(VnDevice device, VkFormat format);

/* ---- Buffers ---- */

typedef struct VnBufferDesc {
    uint32_t _start;
    uint64_t size;    /* bytes; > 0. Every buffer can be used for every purpose */
    const void* data; /* initial contents, `size` bytes; NULL: zeros */
    uint32_t _end;
} VnBufferDesc;

VN_API VnResult vnCreateBuffer(VnDevice device, const VnBufferDesc* desc, VnBuffer* buffer);
VN_API VnResult vnDestroyBuffer(VnDevice device, VnBuffer buffer);
/* The memory of the buffer, for reading and writing until the buffer is destroyed. The caller keeps clear of running
 * work: call vnFinish before, or write only what no command in flight touches. */
VN_API VnResult vnMapBuffer(VnDevice device, VnBuffer buffer, void** memory);

/* ---- Images, views, samplers ---- */

#define VN_ALL_MIPS 0xFFFFFFFFu

typedef struct VnImageDesc {
    uint32_t _start;
    VkFormat format;     /* 0: VK_FORMAT_R8G8B8A8_UNORM */
    uint32_t dimensions; /* 1, 2 or 3; 0: 2 */
    uint32_t width;      /* texels; 1 .. VnDeviceInfo::maxImageSize, of 3D images 1 .. 2048 */
    uint32_t height;     /* of 1D images 0 or 1 */
    uint32_t depth;      /* slices of a 3D image; 0: 1 */
    uint32_t mipLevels;  /* 0: 1; VN_ALL_MIPS: down to 1x1 */
    uint32_t layers;     /* of an array; 0: 1 */
    uint32_t samples;    /* 1, 2, 4, 8 or 16; 0: 1. More than 1: one mip level, no initial contents */
    int cube;            /* nonzero: layers come in sixes and a whole view is a cube (array) */
    uint32_t _end;
} VnImageDesc;

VN_API VnResult vnCreateImage(VnDevice device, const VnImageDesc* desc, VnImage* image);
VN_API VnResult vnDestroyImage(VnDevice device, VnImage image);

typedef struct VnViewDesc {
    uint32_t _start;
    VnImage image;
    VkFormat format;                /* 0: the image's; else one of the same texel size, or block size and footprint */
    VkImageAspectFlags aspect;      /* 0: colour, or depth where there is depth */
    uint32_t baseMip, mipCount;     /* mipCount 0: all that are left */
    uint32_t baseLayer, layerCount; /* layerCount 0: all that are left */
    int array;                      /* nonzero: an array view even of one layer; more layers always make one */
    int slices;                 /* nonzero: the slices of a 3D image as layers of a 2D view, counted by baseLayer and
                                   layerCount; needs mipCount 1. Without it a view of a 3D image is 3D */
    VkComponentMapping swizzle; /* 0: identity */
    uint32_t _end;
} VnViewDesc;

VN_API VnResult vnCreateView(VnDevice device, const VnViewDesc* desc, VnView* view);
VN_API VnResult vnDestroyView(VnDevice device, VnView view);
/* A view of the whole image, made on first use and destroyed with the image. */
VN_API VnResult vnGetImageView(VnDevice device, VnImage image, VnView* view);

typedef struct VnSamplerDesc {
    uint32_t _start;
    VkFilter magFilter, minFilter;                     /* 0: nearest; cubic for colours of 2D views only */
    VkSamplerMipmapMode mipmapMode;                    /* 0: nearest */
    VkSamplerAddressMode addressU, addressV, addressW; /* 0: repeat */
    float lodBias;                                     /* levels; -15 .. 15 */
    float minLod;                                      /* levels */
    float maxLod;      /* levels; 0: no limit. For the base level alone use a view of one level */
    int compareEnable; /* nonzero: a shadow sampler */
    VkCompareOp compareOp;
    VkBorderColor borderColor;           /* 0: transparent black; one of the two CUSTOM colours: the next field */
    VkClearColorValue customBorderColor; /* as the member that the format's texels are read by */
    float maxAnisotropy;                 /* samples per pixel along its longer side, up to 16; 0 or 1: off */
    VkSamplerReductionMode reduction;    /* 0: weighted average; minimum or maximum of the texels of a linear filter */
    int unnormalized; /* nonzero: coordinates in texels; 1D and 2D views of one level, equal filters */
    int seams;        /* nonzero: the faces of cubes are filtered each for itself */
    uint32_t _end;
} VnSamplerDesc;

VN_API VnResult vnCreateSampler(VnDevice device, const VnSamplerDesc* desc, VnSampler* sampler);
VN_API VnResult vnDestroySampler(VnDevice device, VnSampler sampler);

/* ---- Shaders and programs ---- */

typedef struct VnSpecialization {
    uint32_t constantId;
    uint32_t bits; /* the 32 bits of the value: bool 0 or 1, int, uint or float */
} VnSpecialization;

typedef struct VnShaderDesc {
    uint32_t _start;
    VkShaderStageFlagBits stage; /* VK_SHADER_STAGE_VERTEX_BIT, _TESSELLATION_CONTROL_BIT,
                                  * _TESSELLATION_EVALUATION_BIT, _GEOMETRY_BIT, _FRAGMENT_BIT or _COMPUTE_BIT */
    const uint32_t* words;       /* a SPIR-V module; copied */
    size_t wordCount;
    const char* entryPoint;                  /* NULL: "main" */
    const VnSpecialization* specializations; /* copied */
    uint32_t specializationCount;
    uint32_t _end;
} VnShaderDesc;

/* The module is validated; VN_ERROR_SHADER or VN_ERROR_UNSUPPORTED names the instruction. */
VN_API VnResult vnCreateShader(VnDevice device, const VnShaderDesc* desc, VnShader* shader);
VN_API VnResult vnDestroyShader(VnDevice device, VnShader shader);

typedef struct VnProgramDesc {
    uint32_t _start;
    VnShader vertex;
    VnShader fragment; /* {0}: no fragment stage: only depth and stencil are written */
    VnShader compute;  /* stands alone: a program for dispatches */
    /* Tessellation: both or, {0}, none. Draws have the topology VK_PRIMITIVE_TOPOLOGY_PATCH_LIST. */
    VnShader control;
    VnShader evaluation;
    VnShader geometry; /* {0}: none. Draws have a topology of the primitives that it takes */
    VnProfile profile; /* 0: the device's, with its axes */
    const char* axes;  /* NULL, or the axes to change in that: "axis=position ..." */
    uint32_t _end;
} VnProgramDesc;

/* Links the stages: what the fragment shader does not read is not computed. */
VN_API VnResult vnCreateProgram(VnDevice device, const VnProgramDesc* desc, VnProgram* program);
VN_API VnResult vnDestroyProgram(VnDevice device, VnProgram program);

/* ---- State objects ---- */

typedef struct VnVertexAttribute {
    uint32_t location; /* as in the shader; 0 .. 31 */
    uint32_t binding;  /* which vertex buffer; 0 .. 31 */
    VkFormat format;   /* e.g. VK_FORMAT_R32G32B32_SFLOAT */
    uint32_t offset;   /* bytes from the start of the vertex */
} VnVertexAttribute;

typedef struct VnVertexBinding {
    uint32_t stride; /* bytes from one vertex to the next; 0: all read the same */
    int perInstance; /* nonzero: advances per instance instead of per vertex */
} VnVertexBinding;

typedef struct VnVertexLayoutDesc {
    uint32_t _start;
    const VnVertexAttribute* attributes; /* copied */
    uint32_t attributeCount;
    const VnVertexBinding* bindings; /* copied; index = binding number */
    uint32_t bindingCount;
    uint32_t _end;
} VnVertexLayoutDesc;

VN_API VnResult vnCreateVertexLayout(VnDevice device, const VnVertexLayoutDesc* desc, VnVertexLayout* layout);
VN_API VnResult vnDestroyVertexLayout(VnDevice device, VnVertexLayout layout);

typedef struct VnRasterStateDesc {
    uint32_t _start;
    VkPolygonMode polygonMode; /* 0: fill */
    VkCullModeFlags cullMode;  /* 0: none */
    VkFrontFace frontFace;     /* 0: counter-clockwise, seen in the framebuffer (y down) */
    int depthClamp;            /* nonzero: clamp to the viewport's depth range instead of clipping at near and far */
    int depthClip;           /* 0: clip at near and far unless depthClamp is set; 1: clip, -1: do not, clamped or not */
    int depthBias;           /* nonzero: add the following */
    float depthBiasConstant; /* in units of the depth format's resolution */
    float depthBiasSlope;    /* times the slope of the primitive */
    float depthBiasClamp;    /* 0: none */
    float lineWidth;         /* pixels; 0: 1 */
    int provokingVertexLast; /* nonzero: flat inputs come from the last vertex, as in GL */
    uint32_t sampleMaskOff;  /* bits of samples that are never written; 0: all samples are */
    int alphaToCoverage;     /* nonzero: the alpha of colour 0 makes a sample mask: of n samples the first
                                round(alpha * n) */
    int alphaToOne;          /* nonzero: then the alpha of all colours becomes 1 */
    float minSampleShading;  /* 0 .. 1; above 1 / samples: the fragment shader runs once per sample */
    int depthNegativeOneToOne;           /* nonzero: clip depths from -w to w, as in GL, instead of 0 to w */
    int domainLowerLeft;                 /* nonzero: tessellated triangles wind as seen with v upwards, as in GL */
    VkLineRasterizationModeEXT lineMode; /* 0: rectangles; BRESENHAM, RECTANGULAR_SMOOTH (coverage goes into alpha) */
    uint32_t lineStippleFactor;  /* 1 .. 256: lines are stippled, each bit this many pixels long; 0: they are not */
    uint16_t lineStipplePattern; /* 16 bits, the lowest first; a strip goes on where its segments meet */
    /* Nonzero: samples lie at sampleLocations, in sixteenths of a pixel from its upper left corner (0 .. 15), instead
     * of Vulkan's standard positions. */
    int programmableSamples;
    uint8_t sampleLocations[16][2];
    uint32_t _end;
} VnRasterStateDesc;

VN_API VnResult vnCreateRasterState(VnDevice device, const VnRasterStateDesc* desc, VnRasterState* state);
VN_API VnResult vnDestroyRasterState(VnDevice device, VnRasterState state);

/* VK_COMPARE_OP_NEVER is 0, which stands for the default here; say this where you mean never. */
#define VN_COMPARE_OP_NEVER ((VkCompareOp)0x100)

typedef struct VnStencilFace {
    VkStencilOp failOp, passOp, depthFailOp; /* 0: keep */
    VkCompareOp compareOp;                   /* 0: always */
    uint32_t compareMaskOff;                 /* bits not compared; 0: all 8 are */
    uint32_t writeMaskOff;                   /* bits not written; 0: all 8 are */
} VnStencilFace;

typedef struct VnDepthStencilStateDesc {
    uint32_t _start;
    int depthTest;            /* nonzero: on */
    int depthWrite;           /* nonzero: on; needs depthTest */
    VkCompareOp depthCompare; /* 0: less */
    int stencilTest;          /* nonzero: on */
    VnStencilFace front, back;
    int depthBoundsTest; /* nonzero: only where the stored depth lies in minDepth .. maxDepth */
    float minDepth, maxDepth;
    uint32_t _end;
} VnDepthStencilStateDesc;

VN_API VnResult vnCreateDepthStencilState(VnDevice device, const VnDepthStencilStateDesc* desc,
                                          VnDepthStencilState* state);
VN_API VnResult vnDestroyDepthStencilState(VnDevice device, VnDepthStencilState state);

typedef struct VnBlendAttachment {
    int enable; /* nonzero: blend; 0: replace */
    /* All four factors 0: source over, (SRC_ALPHA, ONE_MINUS_SRC_ALPHA, ONE, ONE_MINUS_SRC_ALPHA). */
    VkBlendFactor srcColor, dstColor;
    VkBlendOp colorOp; /* 0: add */
    VkBlendFactor srcAlpha, dstAlpha;
    VkBlendOp alphaOp;                  /* 0: add */
    VkColorComponentFlags writeMaskOff; /* components not written; 0: all are */
} VnBlendAttachment;

typedef struct VnBlendStateDesc {
    uint32_t _start;
    VnBlendAttachment attachments[8];
    int independent;   /* nonzero: each attachment its own; 0: attachments[0] counts for all */
    int logicOpEnable; /* nonzero: logicOp instead of blending (integer and normalised formats) */
    VkLogicOp logicOp;
    uint32_t _end;
} VnBlendStateDesc;

VN_API VnResult vnCreateBlendState(VnDevice device, const VnBlendStateDesc* desc, VnBlendState* state);
VN_API VnResult vnDestroyBlendState(VnDevice device, VnBlendState state);

/* ---- Contexts ---- */

typedef struct VnContextDesc {
    uint32_t _start;
    uint32_t reserved; /* 0 */
    uint32_t _end;
} VnContextDesc;

/* `desc` may be NULL. Everything a context has bound or set starts at its default: no program, all state objects at
 * their defaults ({0}), triangle lists, blend constants 0, stencil reference 0. */
VN_API VnResult vnCreateContext(VnDevice device, const VnContextDesc* desc, VnContext* context);
/* Waits for the context's work. NULL is allowed. */
VN_API void vnDestroyContext(VnContext context);
/* Hands what was recorded to the background; returns at once. Not inside a pass. */
VN_API VnResult vnFlush(VnContext context);
/* vnFlush, then waits until everything has run. */
VN_API VnResult vnFinish(VnContext context);

/* ---- Passes ---- */

typedef struct VnAttachment {
    VnView view;                      /* of one mip level; {0}: this slot is not used */
    VnView resolve;                   /* single-sampled image that gets the samples at the end: their average, or as the
                                         modes say for depth and stencil; {0}: none */
    VkAttachmentLoadOp loadOp;        /* 0: load */
    VkAttachmentStoreOp storeOp;      /* 0: store */
    VkAttachmentLoadOp stencilLoadOp; /* 0: load */
    VkAttachmentStoreOp stencilStoreOp;                 /* 0: store */
    VkClearValue clear;                                 /* used by VK_ATTACHMENT_LOAD_OP_CLEAR */
    VkResolveModeFlagBits depthResolve, stencilResolve; /* 0: sample 0; also MIN, MAX and, of depth, AVERAGE */
} VnAttachment;

typedef struct VnPassDesc {
    uint32_t _start;
    VnAttachment colors[8];
    VnAttachment depthStencil;
    VkRect2D renderArea; /* extent 0: all of the attachments */
    uint32_t viewMask;   /* not 0: multiview: every draw goes to each of these layers, with ViewIndex telling which */
    uint32_t _end;
} VnPassDesc;

/* Starts drawing to the attachments, which all have the same sample count. Of views with several layers all that every
 * view has are drawn to: the vertex or geometry shader chooses with Layer. Sets all viewports and scissors to the
 * render area. A program must not read an attachment of the pass it runs in, unless vnPassBarrier stands between. */
VN_API VnResult vnBeginPass(VnContext context, const VnPassDesc* desc);
VN_API VnResult vnEndPass(VnContext context);
/* What the draws of the pass have written so far can be read by those to come: with subpassLoad, whose input attachment
 * is a view bound with vnBindTexture at its (set, binding), or in any other way. */
VN_API VnResult vnPassBarrier(VnContext context);
/* Clears a rectangle of an attachment inside a pass, in order with the draws. `rect` NULL: the render area. */
VN_API VnResult vnClearColor(VnContext context, uint32_t attachment, const VkClearColorValue* value,
                             const VkRect2D* rect);
VN_API VnResult vnClearDepthStencil(VnContext context, VkImageAspectFlags aspects, float depth, uint32_t stencil,
                                    const VkRect2D* rect);

/* ---- Binding and setting; in or out of a pass; stays until changed ---- */

/* A compute program is bound beside the one for draws; {0} unbinds both. */
VN_API VnResult vnBindProgram(VnContext context, VnProgram program);
/* {0} binds the default state. */
VN_API VnResult vnBindVertexLayout(VnContext context, VnVertexLayout layout);
VN_API VnResult vnBindRasterState(VnContext context, VnRasterState state);
VN_API VnResult vnBindDepthStencilState(VnContext context, VnDepthStencilState state);
VN_API VnResult vnBindBlendState(VnContext context, VnBlendState state);

/* Vertex buffer for vertex binding `binding` (0 .. 31); `offset` in bytes. {0} unbinds. Fetches outside give 0. */
VN_API VnResult vnBindVertexBuffer(VnContext context, uint32_t binding, VnBuffer buffer, uint64_t offset);
/* `type`: VK_INDEX_TYPE_UINT8_EXT, _UINT16 or _UINT32; `offset` in bytes, a multiple of the index size. */
VN_API VnResult vnBindIndexBuffer(VnContext context, VnBuffer buffer, uint64_t offset, VkIndexType type);
/* Uniform or storage buffer at (set, binding, element); set 0 .. 7, binding 0 .. 255, element 0 .. 255. `offset` is a
 * multiple of 4 bytes; `size` 0: to the end. {0} unbinds. Accesses outside read 0 and drop writes (64
 * bits count as two words; offsets are computed modulo 2^32). */
VN_API VnResult vnBindBuffer(VnContext context, uint32_t set, uint32_t binding, uint32_t element, VnBuffer buffer,
                             uint64_t offset, uint64_t size);
/* A combined image and sampler. For a separate texture or sampler, or a storage image, the other handle is {0}. The
 * view must be of the dimension that the program reads: checked by draws and dispatches. */
VN_API VnResult vnBindTexture(VnContext context, uint32_t set, uint32_t binding, uint32_t element, VnView view,
                              VnSampler sampler);
/* A range of a buffer as texels of `format` (samplerBuffer, imageBuffer and their kind). `offset` is a multiple of 16
 * bytes; `size` 0: to the end. {0} unbinds. */
VN_API VnResult vnBindTexelBuffer(VnContext context, uint32_t set, uint32_t binding, uint32_t element, VnBuffer buffer,
                                  VkFormat format, uint64_t offset, uint64_t size);
/* Bytes `offset` .. `offset + size` of the push-constant block; multiples of 4, at most 256 in all. */
VN_API VnResult vnPushConstants(VnContext context, uint32_t offset, const void* data, uint32_t size);

/* Viewport and scissor 0. */
VN_API VnResult vnSetViewport(VnContext context, const VkViewport* viewport);
VN_API VnResult vnSetScissor(VnContext context, const VkRect2D* scissor);
/* Any of the 16 among which the vertex or geometry shader chooses with ViewportIndex. */
VN_API VnResult vnSetViewports(VnContext context, uint32_t first, uint32_t count, const VkViewport* viewports);
VN_API VnResult vnSetScissors(VnContext context, uint32_t first, uint32_t count, const VkRect2D* scissors);
/* `primitiveRestart` nonzero: the largest index starts a new strip or fan. */
VN_API VnResult vnSetTopology(VnContext context, VkPrimitiveTopology topology, int primitiveRestart);
/* Vertices of a patch of VK_PRIMITIVE_TOPOLOGY_PATCH_LIST: 1 to 32, at first 3. */
VN_API VnResult vnSetPatchVertices(VnContext context, uint32_t vertices);
VN_API VnResult vnSetBlendConstants(VnContext context, const float rgba[4]);
/* Low 8 bits count. */
VN_API VnResult vnSetStencilReference(VnContext context, uint32_t front, uint32_t back);

/* ---- Drawing; inside a pass ---- */

VN_API VnResult vnDraw(VnContext context, uint32_t vertexCount, uint32_t instanceCount, uint32_t firstVertex,
                       uint32_t firstInstance);
VN_API VnResult vnDrawIndexed(VnContext context, uint32_t indexCount, uint32_t instanceCount, uint32_t firstIndex,
                              int32_t vertexOffset, uint32_t firstInstance);
/* `drawCount` VkDrawIndirectCommand (or VkDrawIndexedIndirectCommand) structs, `stride` bytes apart (0: tightly
 * packed), from `offset` (a multiple of 4) in `buffer`; read when the command runs. */
VN_API VnResult vnDrawIndirect(VnContext context, VnBuffer buffer, uint64_t offset, uint32_t drawCount,
                               uint32_t stride);
VN_API VnResult vnDrawIndexedIndirect(VnContext context, VnBuffer buffer, uint64_t offset, uint32_t drawCount,
                                      uint32_t stride);

/* ---- Computing; outside a pass ---- */

/* Runs x * y * z work-groups, each at most 65535, of the compute program that is bound. Commands take effect in order:
 * a dispatch sees what was written before it, and what it writes is seen by what comes after. 0 groups do nothing. A
 * work-group has at most 1024 x 1024 x 64 and in all 1024 invocations, and shares at most 32768 bytes. */
VN_API VnResult vnDispatch(VnContext context, uint32_t groupsX, uint32_t groupsY, uint32_t groupsZ);
/* The counts are a VkDispatchIndirectCommand at `offset` (a multiple of 4) in `buffer`, read when the command runs;
 * counts above 65535 run nothing. */
VN_API VnResult vnDispatchIndirect(VnContext context, VnBuffer buffer, uint64_t offset);

/* ---- Moving data; outside a pass ---- */

/* Copies `data` now; the buffer changes in order with the commands before and after. */
VN_API VnResult vnUpdateBuffer(VnContext context, VnBuffer buffer, uint64_t offset, const void* data, uint64_t size);
VN_API VnResult vnFillBuffer(VnContext context, VnBuffer buffer, uint64_t offset, uint64_t size, uint32_t value);

/* A rectangle of one mip level of one layer, or a box of one level of a 3D image. Of a block-compressed image its edges
 * lie between blocks or at the edges of the level. */
typedef struct VnRegion {
    uint32_t mip, layer;
    uint32_t x, y;             /* texels */
    uint32_t width, height;    /* texels; 0: to the edge of the level */
    uint32_t z, depth;         /* slices of a 3D image; depth 0: to the last one */
    VkImageAspectFlags aspect; /* 0: colour, or depth where there is depth */
    uint32_t mirror;           /* of vnBlitImage's destination: bits 1, 2 and 4 turn x, y and z round; else 0 */
} VnRegion;

/* Rows of `data` are tightly packed texels in the image's format (of compressed formats: rows of blocks), slice by
 * slice, `size` bytes in all (of a combined depth-stencil format: of one aspect, as in vkCmdCopyBufferToImage).
 * `region` NULL: level 0 of layer 0. */
VN_API VnResult vnUpdateImage(VnContext context, VnImage image, const VnRegion* region, const void* data,
                              uint64_t size);
/* The reverse: waits for all work of the context, then fills `data`. */
VN_API VnResult vnReadImage(VnContext context, VnImage image, const VnRegion* region, void* data, uint64_t size);
VN_API VnResult vnReadBuffer(VnContext context, VnBuffer buffer, uint64_t offset, void* data, uint64_t size);

/* Ranges and regions of one resource must not overlap, here and below. */
VN_API VnResult vnCopyBuffer(VnContext context, VnBuffer source, uint64_t sourceOffset, VnBuffer destination,
                             uint64_t destinationOffset, uint64_t size);
/* The regions have the same size, counted in blocks where a format is compressed; the formats have the same texel (or
 * block) size. */
VN_API VnResult vnCopyImage(VnContext context, VnImage source, const VnRegion* sourceRegion, VnImage destination,
                            const VnRegion* destinationRegion);
/* Scales and converts between colour formats (to compressed ones never), or between equal depth formats with
 * VK_FILTER_NEAREST. */
VN_API VnResult vnBlitImage(VnContext context, VnImage source, const VnRegion* sourceRegion, VnImage destination,
                            const VnRegion* destinationRegion, VkFilter filter);
VN_API VnResult vnResolveImage(VnContext context, VnImage source, VnImage destination);
/* Fills levels 1 .. n - 1 of every layer from level 0, each by a linear 2:1 blit of the one before. */
VN_API VnResult vnGenerateMips(VnContext context, VnImage image);
VN_API VnResult vnClearImage(VnContext context, VnImage image, const VkClearColorValue* value);

/* ---- Knowing what was done ---- */

/* Sums over the context since it was created or vnResetStatistics. What is not run is not counted: fragments that a
 * later opaque primitive hides, for example. */
typedef struct VnStatistics {
    uint64_t draws;
    uint64_t inputVertices, inputPrimitives;
    uint64_t vertexInvocations;
    uint64_t controlPatches, evaluationInvocations, geometryInvocations;
    uint64_t clippedPrimitives;   /* really cut, not merely tested */
    uint64_t rasterPrimitives;    /* reached the rasteriser */
    uint64_t fragmentInvocations; /* without helpers */
    uint64_t helperInvocations;   /* run only to take derivatives */
    uint64_t samplesPassed;
    uint64_t perspectiveDivides; /* pixels */
    uint64_t destinationReads;   /* pixels whose colour was read back */
    uint64_t depthReads;         /* samples whose depth or stencil was read */
    uint64_t plans;              /* combinations of state that had to be planned */
    uint64_t dispatches;
    uint64_t computeInvocations;
    uint64_t fragmentBatches; /* runs of fragment programs over many pixels, of any number of primitives and draws */
    uint64_t clearedPixels;   /* of all attachments, by load operations; what is drawn over altogether is not cleared */
} VnStatistics;

/* Waits for the context's work. */
VN_API VnResult vnGetStatistics(VnContext context, VnStatistics* statistics);
VN_API VnResult vnResetStatistics(VnContext context);

/* A query counts what the commands between vnBeginQuery and vnEndQuery do. It lies in one pass or around passes, and no
 * submission (vnFlush, reading data) comes between. Hidden work is done all the same meanwhile. */
typedef enum VnQueryType {
    VN_QUERY_OCCLUSION = 0,  /* value: samples that passed all tests */
    VN_QUERY_STATISTICS = 1, /* all but value */
    VN_QUERY_TIMESTAMP = 2   /* value: nanoseconds of a clock that only grows; written, not begun */
} VnQueryType;
typedef struct VnQueryResult {
    uint64_t value;
    uint64_t inputVertices, inputPrimitives, vertexInvocations;
    uint64_t controlPatches, evaluationInvocations;
    uint64_t geometryInvocations, geometryPrimitives; /* primitives that came out */
    uint64_t clippingInvocations, clippingPrimitives, fragmentInvocations, computeInvocations;
} VnQueryResult;

VN_API VnResult vnCreateQuery(VnDevice device, VnQueryType type, VnQuery* query);
VN_API VnResult vnDestroyQuery(VnDevice device, VnQuery query);
VN_API VnResult vnBeginQuery(VnContext context, VnQuery query);
VN_API VnResult vnEndQuery(VnContext context, VnQuery query);
/* Of the moment when all commands before are done. */
VN_API VnResult vnWriteTimestamp(VnContext context, VnQuery query);
/* Waits for the context's work. A query that was never ended or written is VN_ERROR_INVALID_STATE. */
VN_API VnResult vnGetQueryResult(VnContext context, VnQuery query, VnQueryResult* result);

typedef enum VnExplainFormat {
    VN_EXPLAIN_TEXT = 0, /* a line each: "runs      what: why" or "left out  what: why" */
    VN_EXPLAIN_JSON = 1  /* an array of objects: "runs" (true or false), "what", "why"; of programs "instructions" per
                            "lanes" and "rates" (operations and their cost, by how often they run); of what a frame
                            counts "count" */
} VnExplainFormat;

/* What the next draw with the bound state would run (outside a pass: the next dispatch), at what rate and accuracy,
 * what is left out and why. Zero-terminated, cut to `capacity` bytes; `length` (may be NULL) receives the full length
 * without the zero. */
VN_API VnResult vnExplain(VnContext context, VnExplainFormat format, char* text, size_t capacity, size_t* length);
/* What was run and left out since vnResetStatistics, and how often. Waits for the context's work. */
VN_API VnResult vnExplainFrame(VnContext context, VnExplainFormat format, char* text, size_t capacity, size_t* length);

#ifdef __cplusplus
}
#endif

#endif /* VERNIER_H */
