#version 450
layout(location = 0) in float smoothValue;
layout(location = 1) noperspective in float linearValue;
layout(location = 2) flat in float flatValue;
layout(location = 3) flat in int flatBits;
layout(location = 0) out ivec4 result;
void main() { result = ivec4(flatBits); }
