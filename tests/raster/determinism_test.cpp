#include "tests/raster/harness.h"
