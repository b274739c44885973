// The macros that make shaders valid C++ (shaders/device/language.glsl explains them). GLM provides the types and
// functions. Nothing but shaders may be included after this header, as it makes words such as `in` disappear.
#pragma once

#define FOVEA_LANGUAGE_GLSL
#define FOVEA_DEVICE_TEXELS_GLSL
#define FOVEA_TABLES_GLSL

#define CONSTANT static inline const
#define INOUT(type) type&
#define OUT(type) type&
#define DECLARE(function)
#define IMAGE(format, access, type, name) type name = port<type>(#name)
#define LIST(access, type, name) List<type> name = port<List<type>>(#name)
#define VALUE(access, type, name) Single<type> name = port<Single<type>>(#name)
#define TEXTURE(type, name) type name = port<type>(#name)
#define LARGE_TEXELS(type, name) Texels<type> name = port<Texels<type>>(#name)
#define SCENE_TEXELS(number, type, name)
#define texelOf(name, i) name[i]
#define COUNTERS struct Counters
#define layout(...)
#define uniform struct
#define precise
#define in
