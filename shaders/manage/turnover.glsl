// How many VPLs may be deleted for failing Eq. 1. Define: CHANGE 0/1, whether changes of the light are known. Needs
// manage/memory.glsl.
#ifndef FOVEA_MANAGE_TURNOVER_GLSL
#define FOVEA_MANAGE_TURNOVER_GLSL

#if CHANGE
uniform samplerBuffer change;  // z: share of what was known of the light that is lost

uint mostFailing() { return max(mostRejected, uint(ceil(changeTurnover * texelFetch(change, 0).z * float(slots)))); }
#else
uint mostFailing() { return mostRejected; }
#endif

#endif
