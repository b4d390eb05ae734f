// Handing errors up.
#pragma once

#include "base/result.h"

/// Leaves the calling function with the error of a Status.
#define VERNIER_TRY(expression)                                                                    \
    do {                                                                                           \
        if (::vernier::Status tryStatus = (expression); !tryStatus.ok()) return tryStatus.error(); \
    } while (false)
