// Combines eight children into a cell of the next level, in a fixed order of sums.
#ifndef FOVEA_MIPMAP_COMBINE_GLSL
#define FOVEA_MIPMAP_COMBINE_GLSL

struct Cell {
  vec4 color;    // rgb: radiance times coverage; a: coverage, see voxels/cone.glsl
  float weight;  // times coverage
};
const Cell kEmpty = Cell(vec4(0.0), 0.0);

const int kFaces = DIRECTIONAL != 0 ? 6 : 1;

// Children are numbered by bits x, y, z of their index. Face +x -x +y -y +z -z is seen from that side, so the near
// one of the column's two children comes first. A single volume for all directions has no near and far.
int axisOf(int face) { return face >> 1; }
int columnChild(int face, int column, int along) {
  int axis = axisOf(face);
  return axis == 0   ? along | column << 1
         : axis == 1 ? (column & 1) | along << 1 | (column & 2) << 1
                     : column | along << 2;
}
int nearChild(int face, int column) { return columnChild(face, column, 1 - (face & 1)); }
int farChild(int face, int column) { return columnChild(face, column, face & 1); }

Cell add(Cell a, Cell b) { return Cell(a.color + b.color, a.weight + b.weight); }

// The far child shows through where the near one leaves space. Parts of one slanted surface do not hide each other,
// so coverage adds up to 1 before anything is hidden.
Cell behind(Cell near, Cell far) {
#if DIRECTIONAL
  float share = clamp((1.0 - near.color.a) / max(far.color.a, 1e-6), 0.0, 1.0);
  return Cell(near.color + share * far.color, near.weight + share * far.weight);
#else
  return add(near, far);
#endif
}

vec4 stored(vec4 v) { return min(v, 65504.0); }

#endif
