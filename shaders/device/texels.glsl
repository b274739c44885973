// Texel buffers that may have more texels than a device of few maxTexelBufferElements allows, where they are storage
// buffers: LARGE_TEXELS(vec4, radiance); declares one, and texelOf(radiance, i) reads it. A CPU device reads texel
// buffers ten times as fast.
#ifndef FOVEA_DEVICE_TEXELS_GLSL
#define FOVEA_DEVICE_TEXELS_GLSL

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
