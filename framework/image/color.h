// Colour spaces of the sRGB display: linear RGB, CIE XYZ and CIELAB, with white D65 as in sRGB. The transfer function
// is in fovea/image.h.
#pragma once

#include <array>

namespace fovea::image {

using Color = std::array<double, 3>;

Color xyzFromLinear(const Color& rgb);  // Y of white is 1
Color linearFromXyz(const Color& xyz);
const Color& whiteXyz();

// CIE 1976: L* 0..100, a*, b*.
Color labFromXyz(const Color& xyz);
Color xyzFromLab(const Color& lab);

// The linear space YCxCz, whose axes are the channels in which the contrast sensitivity of the eye is measured.
Color ycxczFromXyz(const Color& xyz);
Color xyzFromYcxcz(const Color& ycxcz);

}  // namespace fovea::image
