#version 450
layout(location = 0) in vec4 position;
layout(location = 1) in vec4 color;
layout(location = 0) out float smoothValue;
layout(location = 1) noperspective out float linearValue;
layout(location = 2) flat out float flatValue;
layout(location = 3) flat out int flatBits;
void main() {
    gl_Position = position;
    smoothValue = color.x;
    linearValue = color.y;
    flatValue = color.z;
    flatBits = floatBitsToInt(color.w);
}
