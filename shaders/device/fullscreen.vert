// The vertex shader of full-screen steps: one triangle over the whole image or, if FOVEA_TILE_MASK names a mask, two
// over each tile whose texel is not 0 there. The viewport then spans whole tiles.

#ifdef FOVEA_TILE_MASK
layout(r8) uniform readonly image2D FOVEA_TILE_MASK;

// Names end in an underscore so that they cannot be that of the mask.
void main() {
  ivec2 count_ = imageSize(FOVEA_TILE_MASK);
  int tile_ = gl_VertexIndex / 6, corner_ = gl_VertexIndex % 6;
  corner_ = corner_ < 3 ? corner_ : 6 - corner_;  // 0 1 2, 3 2 1
  ivec2 at_ = ivec2(tile_ % count_.x, tile_ / count_.x);
  bool drawn_ = imageLoad(FOVEA_TILE_MASK, at_).r > 0.0;
  vec2 place_ = 2.0 * vec2(at_ + ivec2(corner_ & 1, corner_ >> 1)) / vec2(count_) - 1.0;
  gl_Position = vec4(drawn_ ? place_ : vec2(-1.0), 0.5, 1.0);
}
#else
void main() { gl_Position = vec4(gl_VertexIndex == 1 ? 3.0 : -1.0, gl_VertexIndex == 2 ? 3.0 : -1.0, 0.5, 1.0); }
#endif
