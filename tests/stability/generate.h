// Random soups, each from a seed alone, the same everywhere.
#pragma once

#include "tests/stability/soup.h"

#include <cstdint>

namespace vernier::stability {

// X(function, what it makes)
#define VERNIER_SOUPS(X)                                                                                      \
    X(triangulation, "points in a rectangle, inserted one by one, with random flips of edges; on 1/16 pixel") \
    X(offGrid, "the same with points between the steps of any grid")                                          \
    X(fan, "3 to 64 triangles around a hub, which may be a centre")                                           \
    X(slivers, "a band of triangles between two lines a few sub-units apart")                                 \
    X(clippedSheet, "a triangulation lifted into clip space, through the near and the eye plane")             \
    X(heap, "overlapping triangles, with w and sizes of any magnitude")                                       \
    X(degenerate, "triangles without area, almost without, and with equal vertices, among others")            \
    X(poisoned, "a heap some of whose coordinates are infinite or NaN")

#define VERNIER_DECLARE_SOUP(name, text) Soup name(uint64_t seed);
VERNIER_SOUPS(VERNIER_DECLARE_SOUP)
#undef VERNIER_DECLARE_SOUP

}  // namespace vernier::stability
