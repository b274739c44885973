// The vertex of the scene that a vertex shader is at, in what Commands::drawTriangles() draws; and the layer of the
// image that it is drawn into. The framework defines WITHOUT_FEATURE for what a device lacks.
#ifndef FOVEA_DEVICE_VERTEX_GLSL
#define FOVEA_DEVICE_VERTEX_GLSL

#ifndef WITHOUT_shaderOutputLayer
#extension GL_ARB_shader_viewport_layer_array : require
#endif
#include "scene/scene.glsl"

#ifdef WITHOUT_geometryShader
// Draws are not indexed, and count the corners of triangles.
layout(location = 15) flat out uint drawn;

uint drawnVertex() {
  drawn = uint(gl_VertexIndex) / 3u;
  return sceneTriangle(drawn)[uint(gl_VertexIndex) % 3u];
}
#else
uint drawnVertex() { return uint(gl_VertexIndex); }
#endif

// Each instance goes into the layer of its number. Without the feature each layer is rendered by itself, with the
// instance of its number only.
uint drawnLayer() {
#ifndef WITHOUT_shaderOutputLayer
  gl_Layer = gl_InstanceIndex;
#endif
  return uint(gl_InstanceIndex);
}

#endif
