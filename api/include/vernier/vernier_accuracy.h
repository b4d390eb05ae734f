/* The accuracy dial in detail: the axes behind the profiles, and how to choose a profile by what a frame may cost. */
#ifndef VERNIER_ACCURACY_H
#define VERNIER_ACCURACY_H

#include <vernier/vernier.h>

#ifdef __cplusplus
extern "C" {
#endif

/* An axis is set by name, in VnDeviceDesc::axes and VnProgramDesc::axes: "subpixel=12 math=fine" changes these two of
 * what the profile says. */
typedef struct VnAxisInfo {
    const char* name;             /* "subpixel" */
    const char* meaning;          /* in words */
    const char* const* positions; /* from cheap to exact, e.g. "4", "8", "12", "16" */
    uint32_t positionCount;
    uint32_t lowestForVulkan; /* positions before this one are below what Vulkan asks for */
} VnAxisInfo;

/* The axes, from 0; VN_ERROR_INVALID_ARGUMENT behind the last one. Thread-safe, like the next function. */
VN_API VnResult vnGetAxis(uint32_t index, VnAxisInfo* info);
/* Where axis `index` stands in a profile: an index into `positions`. */
VN_API VnResult vnGetAxisPosition(uint32_t index, VnProfile profile, uint32_t* position);

/* ---- A budget ---- */

typedef struct VnBudgetDesc {
    uint32_t _start;
    double maxMilliseconds; /* per frame; 0: time is not bound */
    double maxError;        /* largest difference of a value from VN_PROFILE_REFERENCE's; 0: errors are not bound */
    int belowVulkan;        /* nonzero: profiles below what Vulkan asks for may be chosen, too */
    /* Draws one frame with programs or a device of `profile`, and waits for it. Called several times in a row with each
     * profile that is tried; what it makes may be kept from one call to the next. */
    VnResult (*draw)(void* user, VnProfile profile);
    /* Fills in the values of the frame drawn last (colours, say); needed when errors are bound. */
    VnResult (*read)(void* user, double* values, size_t count);
    size_t valueCount;
    void* user;
    double (*clock)(void* user); /* milliseconds since some moment; NULL: the system's steady clock */
    uint32_t _end;
} VnBudgetDesc;

typedef struct VnBudgetResult {
    VnProfile profile;
    double milliseconds; /* of a frame of that profile: the median of five, after one that is not counted */
    double error;        /* against VN_PROFILE_REFERENCE, when errors are bound; infinite where a value is no number */
} VnBudgetResult;

/* With a bound of time: the most exact profile that keeps it, and the bound of error, if any. With a bound of error
 * alone: the fastest profile that keeps it. VN_ERROR_UNSUPPORTED when no profile keeps the bounds; `result` is then of
 * the fastest one. An error of a callback ends the search and is returned. */
VN_API VnResult vnChooseProfile(const VnBudgetDesc* desc, VnBudgetResult* result);

#ifdef __cplusplus
}
#endif

#endif /* VERNIER_ACCURACY_H */
