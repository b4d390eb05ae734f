// The families of handlers; each fills its part of the table for an instruction set.
#pragma once

#include "base/simd.h"
#include "spirv_interp/batch/bytecode.h"

namespace vernier::batch {

using AddHandlers = void (*)(HandlerTables&);

void addFloatOps(Isa isa, HandlerTables& tables);             // float_ops.cpp: FLOAT operations, dot products
void addIntegerOps(Isa isa, HandlerTables& tables);           // integer_ops.cpp: INTEGER operations
void addFusedOps(Isa isa, HandlerTables& tables);             // fused_ops.cpp: FUSED operations, unpacking
void addLaneOps(Isa isa, HandlerTables& tables);              // lane_ops.cpp: LANES operations
void addWide(Isa isa, HandlerTables& tables);                 // wide.cpp: 64-bit values
void addMath(Isa isa, MathTier tier, HandlerTables& tables);  // math.cpp: transcendental functions
void addFlow(Isa isa, HandlerTables& tables);                 // flow.cpp: masks, jumps, moves, derivatives; images
void addMemory(Isa isa, HandlerTables& tables);               // memory.cpp: buffers, local memory, indexed inputs
void addAtomics(Isa isa, HandlerTables& tables);              // atomics.cpp: atomics, memory by address

// Plain handlers that are the same for every instruction set.
const Inst* controlBarrier(Frame& frame, const Inst* inst);  // barrier.cpp
const Inst* memoryBarrier(Frame& frame, const Inst* inst);
const Inst* readClock(Frame& frame, const Inst* inst);  // clock.cpp
const Inst* runImage(Frame& frame, const Inst* inst);   // images.cpp
const Inst* runInterpolation(Frame& frame, const Inst* inst);
const Inst* subgroupInvocation(Frame& frame, const Inst* inst);  // subgroup.cpp
const Inst* subgroupBallot(Frame& frame, const Inst* inst);
const Inst* subgroupActive(Frame& frame, const Inst* inst);
const Inst* subgroupShuffle(Frame& frame, const Inst* inst);
const Inst* subgroupBroadcast(Frame& frame, const Inst* inst);
const Inst* quadShuffle(Frame& frame, const Inst* inst);
const Inst* subgroupReduce(Frame& frame, const Inst* inst);
const Inst* subgroupReduce64(Frame& frame, const Inst* inst);

}  // namespace vernier::batch
