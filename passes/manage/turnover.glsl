// How many VPLs are deleted. Define: CHANGE 0/1, whether changes of the light are known. Needs manage/memory.glsl.
#ifndef FOVEA_MANAGE_TURNOVER_GLSL
#define FOVEA_MANAGE_TURNOVER_GLSL

#if CHANGE
uniform samplerBuffer change;  // z: share of what was known of the light that is lost

// The least that lose their place, as they were chosen by light that is lost. By the square of the share, so that light
// that changes a little in every frame replaces none.
uint outdated() {
  float lost = texelFetch(change, 0).z;
  return uint(changeTurnover * lost * lost * float(slots));
}
#else
uint outdated() { return 0u; }
#endif

// The most that are deleted for failing Eq. 1.
uint mostFailing() { return max(mostRejected, outdated()); }

#endif
