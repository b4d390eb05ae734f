#version 450
#extension GL_KHR_shader_subgroup_arithmetic : require
#extension GL_KHR_shader_subgroup_ballot : require
#extension GL_KHR_shader_subgroup_shuffle : require
#extension GL_KHR_shader_subgroup_vote : require
// Strips as long as the subgroup thinks right: every step asks who is still at it.
//! vulkan 1.1
//! inputs uniform -4 4
layout(lines) in;
layout(triangle_strip, max_vertices = 8) out;
layout(location = 0) in vec4 colour[];
layout(location = 0) out vec4 outColour;
layout(location = 1) flat out uvec4 counts;
void main() {
    uvec4 here = subgroupBallot(true);
    uint me = gl_SubgroupInvocationID, other = me ^ 5u;
    vec4 theirs = subgroupShuffle(colour[0], other);
    if (!subgroupBallotBitExtract(here, other)) theirs = colour[1];
    int steps = clamp(int(abs(colour[0].x) * 2.0), 0, 7);
    for (int n = 0; n < steps; ++n) {
        uvec4 still = subgroupBallot(true);
        counts = uvec4(still.x, subgroupAdd(uint(n) + me), subgroupBallotInclusiveBitCount(still), uint(steps));
        if (subgroupAll(colour[0].y > 0.0)) break;
        outColour = mix(colour[0], theirs, float(n) / float(steps));
        gl_Position = vec4(outColour.xyz, subgroupMax(colour[1].w));
        EmitVertex();
        if ((n + int(me)) % 3 == 2) {
            counts.w = subgroupXor(1u << me);
            EndPrimitive();
        }
    }
    counts = uvec4(subgroupElect() ? 1u : 0u, gl_SubgroupLtMask.x, subgroupMin(steps), here.x);
    outColour = theirs;
    gl_Position = colour[1];
    EmitVertex();
}
