// The triangle of the scene that a fragment shader is at, in what Commands::drawTriangles() draws. The vertex shader
// has to use device/vertex.glsl.
#ifndef FOVEA_DEVICE_FRAGMENT_GLSL
#define FOVEA_DEVICE_FRAGMENT_GLSL

#ifdef WITHOUT_geometryShader
layout(location = 15) flat in uint drawn;

uint drawnTriangle() { return drawn; }
#else
layout(push_constant) uniform Draw { uint firstTriangle; };

uint drawnTriangle() { return firstTriangle + uint(gl_PrimitiveID); }
#endif

#endif
