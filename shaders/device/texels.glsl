// Read-only buffers of texels that may be larger than some devices allow (maxTexelBufferElements): there they are
// storage buffers. Everywhere else they are texel buffers, which a CPU device reads ten times as fast.
#ifndef FOVEA_DEVICE_TEXELS_GLSL
#define FOVEA_DEVICE_TEXELS_GLSL

// LARGE_TEXELS(vec4, radiance); declares the port `radiance` with texels of type float, vec4, uint or uvec4;
// texelOf(radiance, i) reads texel i, an int, and texelsIn(radiance) is their number.
#ifdef WITHOUT_maxTexelBufferElements
#define LARGE_TEXELS(type, name) readonly buffer name##Texels { type list[]; } name
#define texelOf(name, i) name.list[i]
#define texelsIn(name) name.list.length()
#else
#define LARGE_TEXELS(type, name) uniform TEXELS_##type name

#define TEXELS_float samplerBuffer
#define TEXELS_vec4 samplerBuffer
#define TEXELS_uint usamplerBuffer
#define TEXELS_uvec4 usamplerBuffer

#define texelOf(name, i) texelFetch(name, i)
#define texelsIn(name) textureSize(name)
#endif

#endif
