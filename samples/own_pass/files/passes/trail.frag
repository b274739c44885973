uniform texture2D picture, before;
layout(push_constant) uniform Constants { float fade; };
layout(location = 0) out vec4 image;

void main() {
  ivec2 p = ivec2(gl_FragCoord.xy);
  image = max(texelFetch(picture, p, 0), fade * texelFetch(before, p, 0));
}
