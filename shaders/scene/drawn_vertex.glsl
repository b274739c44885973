// Which vertex of the scene a vertex shader is at, in draws by Commands::drawTriangles(), and the layer of the image
// that it draws into. The framework defines WITHOUT_geometryShader and WITHOUT_shaderOutputLayer where a device lacks
// these.
#ifndef FOVEA_DRAWN_VERTEX_GLSL
#define FOVEA_DRAWN_VERTEX_GLSL

#ifndef WITHOUT_shaderOutputLayer
#extension GL_ARB_shader_viewport_layer_array : require
#endif
#include "scene/scene.glsl"

#ifdef WITHOUT_geometryShader
layout(location = 15) flat out uint drawn;  // draws are not indexed, and count the corners of triangles

// Number of the vertex, for scenePosition() and the like.
uint drawnVertex() {
  drawn = uint(gl_VertexIndex) / 3u;
  return sceneTriangle(drawn)[uint(gl_VertexIndex) % 3u];
}
#else
uint drawnVertex() { return uint(gl_VertexIndex); }
#endif

// Sends each instance into the layer of its number, and returns that number. Without the feature each layer is rendered
// by itself, with its own instance alone.
uint drawnLayer() {
#ifndef WITHOUT_shaderOutputLayer
  gl_Layer = gl_InstanceIndex;
#endif
  return uint(gl_InstanceIndex);
}

#endif
