// Turns the keys of the pixels into colours, over the picture.
#include "scene/scene.glsl"
#include "screen/colour_map.glsl"
#include "vpls/vpl.glsl"

layout(local_size_x = 8, local_size_y = 8) in;

uniform usamplerBuffer state;  // VplState
#if LUMINANCE
uniform samplerBuffer vpls;  // Vpl
#endif
#if PICTURE
uniform texture2D picture;
#endif
layout(std430) readonly buffer KeysBlock { uint pixel[]; } keys;
layout(rgba16f) uniform writeonly image2D image;

layout(push_constant) uniform Constants { float scale; };  // 1 / value shown as the last colour

float valueOf(uint slot) {
#if LUMINANCE
  return dot(loadVpl(vpls, slot).intensity, vec3(0.2126, 0.7152, 0.0722));
#elif AGE
  return loadVplState(state, slot).life;
#else
  return loadVplState(state, slot).importance;
#endif
}

void main() {
  ivec2 p = ivec2(gl_GlobalInvocationID.xy), size = imageSize(image);
  if (any(greaterThanEqual(p, size))) return;
  uint key = keys.pixel[p.y * size.x + p.x];
  vec3 colour = vec3(0.0);
#if PICTURE
  if (all(lessThan(p, textureSize(picture, 0)))) colour = texelFetch(picture, p, 0).rgb;
#endif
  if (key != 0xffffffffu) colour = displayColour(colourMap(valueOf(key & 0xffffu) * scale));
  imageStore(image, p, vec4(min(colour, vec3(65504.0)), 1.0));
}
