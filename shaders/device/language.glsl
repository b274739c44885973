// The few words in which a header or a kernel has to be written so that it is GLSL and C++ alike. The framework compiles
// the kernels of passes that trace rays for the host as well (framework/scene/host/kernel.h), where these macros have
// other definitions, and where a binding is a member of the kernel.
//
// Such code has no recursion, no swizzles and no names that C++ reserves; its literals have a decimal point; the only
// functions of images and buffers that it calls are imageSize, imageLoad, imageStore, texelFetch, textureSize and
// atomics; and its work groups share nothing.
#ifndef FOVEA_LANGUAGE_GLSL
#define FOVEA_LANGUAGE_GLSL

// A constant that belongs to no function.
#define CONSTANT const

// Parameters that a function changes.
#define INOUT(type) inout type
#define OUT(type) out type

// A function that whoever includes the header defines.
#define DECLARE(function) function

// Ports of the pass. access: readonly, writeonly, or restrict for both.
// A storage image: IMAGE(rgba16f, readonly, image2D, gbufferNormal);
#define IMAGE(format, access, type, name) layout(format) uniform access type name
// A storage buffer of many elements, `name.list`, or of one, `name.value`.
#define LIST(access, type, name) layout(std430) access buffer name##Block { type list[]; } name
#define VALUE(access, type, name) layout(std430) access buffer name##Block { type value; } name
// A texture or a texel buffer: TEXTURE(texture2D, picture);
#define TEXTURE(type, name) uniform type name
// The counters of the pass, all of them in the order of their declaration: COUNTERS { uint rays, hidden; } counters;
#define COUNTERS layout(std430) buffer CountersBlock

// A texel buffer of descriptor set 1.
#define SCENE_TEXELS(number, type, name) layout(set = 1, binding = number) LARGE_TEXELS(type, name)

#endif
