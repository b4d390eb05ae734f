#version 450
// A little stack machine interpreted per fragment: switch in a loop, a local array as the stack.
//! buffer 0 0 512 integer 0 4095
layout(location = 0) in vec4 source;
layout(location = 0) out vec4 colour;
layout(std430, set = 0, binding = 0) readonly buffer Code { uint code[]; };
void main() {
    float stack[8] = float[](0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0);
    int top = 0, counter = int(gl_FragCoord.x) % 7;
    float registers[4] = float[](source.x, source.y, source.z, source.w);
    for (int steps = 0; steps < 48; ++steps) {
        uint word = code[counter & 127];
        ++counter;
        uint r = word >> 4 & 3u;
        switch (word & 15u) {
            case 0u: case 1u: case 2u:
                stack[top & 7] = registers[r]; top = min(top + 1, 7); break;
            case 3u: top = max(top - 1, 0); registers[r] = stack[top]; break;
            case 4u: registers[r] += stack[max(top - 1, 0)];  // falls through
            case 5u: registers[r ^ 1u] *= 0.5; break;
            case 6u: registers[r] = sin(registers[r]); break;
            case 7u: registers[r] = max(registers[r], registers[(r + 1u) & 3u]); break;
            case 8u: if (registers[r] > 0.0) counter += int(word >> 8); break;
            case 9u: registers[r] = -registers[r]; continue;
            case 10u: registers[r] = fract(registers[r] * 3.7); break;
            case 11u: if (registers[0] > 4.0) { steps += 8; break; } registers[0] += 1.0; break;
            case 12u: registers[r] = registers[r] * registers[r]; if (registers[r] > 1e6) registers[r] = 0.0; break;
            default: registers[3] = float(counter & 127) * 0.01; break;
        }
        if (steps > 40 && registers[1] < 0.0) break;
    }
    colour = vec4(registers[0], registers[1], registers[2], stack[3] + registers[3]);
}
