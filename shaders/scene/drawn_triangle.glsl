// Which triangle of the scene a fragment belongs to, in draws by Commands::drawTriangles().
//
// Needs a vertex shader that includes scene/drawn_vertex.glsl.
#ifndef FOVEA_DRAWN_TRIANGLE_GLSL
#define FOVEA_DRAWN_TRIANGLE_GLSL

#ifdef WITHOUT_geometryShader
layout(location = 15) flat in uint drawn;

// Number of the triangle, for sceneTriangle().
uint drawnTriangle() { return drawn; }
#else
layout(push_constant) uniform Draw { uint firstTriangle; };

uint drawnTriangle() { return firstTriangle + uint(gl_PrimitiveID); }
#endif

#endif
