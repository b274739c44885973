// A VPL as pixels in contact choose it.
struct ContactSource {
  vec3 position;  // world space, m
  float area;     // of its disc, divided by pi, m^2
  vec3 normal;
  float weight;   // sum over the channels of its intensity, times the chance that a ray reaches it; 0 in an empty slot
  vec3 color;     // intensity divided by the weight
  float unused;
};
