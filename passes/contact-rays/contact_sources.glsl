// Four VPLs of one subset, as pixels in contact choose among them: each quantity of all four side by side. VPL i belongs
// to subset i mod kContactSubsets, in which it is number i / kContactSubsets; the fours of a subset follow each other.
struct ContactSources {
  vec4 x, y, z;                    // position in world space, m
  vec4 normalX, normalY, normalZ;
  vec4 area;                       // of its disc, divided by pi, m^2
  vec4 weight;  // sum over the channels of its intensity, times the chance that a ray reaches it; 0 in an empty slot
};

// The VPL in a slot, by its subset and its number there.
uint slotOf(uint subset, uint number) { return number * kContactSubsets + subset; }
