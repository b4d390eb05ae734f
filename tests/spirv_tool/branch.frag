#version 450
layout(location = 0) in float x;
layout(location = 0) out float y;
void main() {
    float t = 2.0 * 3.0;
    if (x > 0.5)
        y = x * t + 1.0;
    else
        y = x * t - 1.0;
}
