#version 450
#extension GL_ARB_gpu_shader_int64 : require
#extension GL_ARB_shader_clock : require
#extension GL_EXT_shader_realtime_clock : require
// What is known of clocks without knowing the time: no reading is before the one that came earlier.
//! vulkan 1.1
//! buffer 0 0 256 integer 1 9
//! buffer 0 1 256 zero
layout(local_size_x = 64) in;
layout(std430, set = 0, binding = 0) readonly buffer Source { uint source[]; };
layout(std430, set = 0, binding = 1) writeonly buffer Result { uint result[]; };
void main() {
    uint i = gl_LocalInvocationIndex, inOrder = 0u;
    uint64_t first = clockRealtimeEXT(), last = first;
    uvec2 words = clock2x32ARB();
    for (uint k = 0u; k < source[i]; ++k) {
        uint64_t now = (k & 1u) != 0u ? clockARB() : clockRealtimeEXT();
        inOrder += now >= last ? 1u : 0u;
        last = now;
    }
    uvec2 end = clockRealtime2x32EXT();
    bool after = end.y > words.y || (end.y == words.y && end.x >= words.x);
    result[i] = inOrder | (after ? 256u : 0u) | (last >= first ? 512u : 0u);
}
