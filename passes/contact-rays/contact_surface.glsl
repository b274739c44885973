// The surfaces of pixels in contact (pass contacts).
#include "scene/octahedral.glsl"
#include "screen/pixel_ray.glsl"

IMAGE(rg32ui, readonly, uimage2D, contacts);

struct ContactSurface {
  vec3 position, normal;  // world space, m; unit
};

bool inContact(ivec2 pixel) { return imageLoad(contacts, pixel).x != 0u; }

ContactSurface contactSurface(ivec2 pixel) {
  uvec2 contact = uvec2(imageLoad(contacts, pixel));
  return ContactSurface(view.eye + uintBitsToFloat(contact.x) * normalize(pixelRay(pixel)),
                        octDecode(unpackSnorm2x16(contact.y)));
}
