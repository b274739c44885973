layout(local_size_x = 8, local_size_y = 8) in;

uniform texture2D left;
uniform texture2D right;
layout(rgba8) uniform writeonly image2D image;

vec4 texelOf(texture2D picture, ivec2 p) {
  return p.y < textureSize(picture, 0).y ? texelFetch(picture, p, 0) : vec4(0.0, 0.0, 0.0, 1.0);
}

void main() {
  ivec2 p = ivec2(gl_GlobalInvocationID.xy);
  if (any(greaterThanEqual(p, imageSize(image)))) return;
  int width = textureSize(left, 0).x;
  imageStore(image, p, p.x < width ? texelOf(left, p) : texelOf(right, p - ivec2(width, 0)));
}
