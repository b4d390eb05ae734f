layout(location = 0) in vec2 uv;
layout(location = 0) out vec4 color;

void main() {
    color = image(uv);
}
