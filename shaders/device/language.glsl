// The macros with which a header or a kernel is GLSL and C++ alike. The build compiles the kernels of the stock passes
// that trace rays for the host as well. There these macros have other definitions (device/language.h), and a binding is
// a member of the kernel.
//
// Such code has no recursion, no swizzles and no names that C++ reserves. Its float literals have a decimal point. Of
// the functions of images and buffers it calls only imageSize, imageLoad, imageStore, texelFetch, textureSize and
// atomics. Its push constants have vectors before scalars. Its work groups have no shared memory and no barriers. A
// pass of your own that runs on the device alone need not keep to this.
#ifndef FOVEA_LANGUAGE_GLSL
#define FOVEA_LANGUAGE_GLSL

// A constant outside of functions: CONSTANT float kPi = 3.14159265;
#define CONSTANT const

// Parameters that a function changes, and those that it only writes: void add(INOUT(vec3) sum, vec3 light);
#define INOUT(type) inout type
#define OUT(type) out type

// A function that a header calls and that whoever includes it defines: DECLARE(float discArea());
#define DECLARE(function) function

// Ports of the pass. access: readonly, writeonly, or restrict for both; name: that of the port.
// A storage image: IMAGE(rgba16f, readonly, image2D, gbufferNormal);
#define IMAGE(format, access, type, name) layout(format) uniform access type name
// A storage buffer of many elements, `name.list`, or of one, `name.value`.
#define LIST(access, type, name) layout(std430) access buffer name##Block { type list[]; } name
#define VALUE(access, type, name) layout(std430) access buffer name##Block { type value; } name
// A texture or a texel buffer: TEXTURE(texture2D, picture);
#define TEXTURE(type, name) uniform type name
// The counters of the pass, all of them in the order of their declaration: COUNTERS { uint rays, hidden; } counters;
#define COUNTERS layout(std430) buffer CountersBlock

// A texel buffer of descriptor set 1, declared by the library alone.
#define SCENE_TEXELS(number, type, name) layout(set = 1, binding = number) LARGE_TEXELS(type, name)

#endif
