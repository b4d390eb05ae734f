// The families of handlers; each fills its part of the table for an instruction set.
#pragma once

#include "base/simd.h"
#include "spirv_interp/batch/bytecode.h"

namespace vernier::batch {

using AddHandlers = void (*)(HandlerTable&);

void addArithmetic(Isa isa, HandlerTable& table);           // arithmetic.cpp: VECTOR operations, dot products
void addLaneOps(Isa isa, HandlerTable& table);              // lane_ops.cpp: LANES operations
void addSubgroups(HandlerTable& table);                     // subgroup.cpp: ballots, shuffles, reductions
void addWide(Isa isa, HandlerTable& table);                 // wide.cpp: 64-bit values
void addMath(Isa isa, MathTier tier, HandlerTable& table);  // math.cpp: transcendental functions
void addBarriers(HandlerTable& table);                      // barrier.cpp: control and memory barriers
void addFlow(Isa isa, HandlerTable& table);                 // flow.cpp: masks, jumps, moves, derivatives
void addMemory(Isa isa, HandlerTable& table);               // memory.cpp: buffers, local memory, indexed inputs
void addAtomics(Isa isa, HandlerTable& table);              // atomics.cpp: atomics, memory by address
void addImages(HandlerTable& table);                        // images.cpp: image instructions, interpolation

}  // namespace vernier::batch
