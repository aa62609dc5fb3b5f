// SPDX-License-Identifier: GPL-3.0-or-later
// The further bounces of anisotropic metal without noise: two reflections and a ramp about the
// normal. The reflections' normals tilt in the plane of the stretched view.
#ifndef MICROBOUNCE_FITTED_ANISOTROPIC_H
#define MICROBOUNCE_FITTED_ANISOTROPIC_H

#include "../tables/anisotropic_lobes.h"
#include "fitted.h"
#include "frame.h"
#include "ramp.h"

// The view's height as a surface of alpha 1 sees it: 1 along the normal, 0 at the horizon.
float stretched_cosine(vector stretched)
{
  return stretched[2] / (stretched[2] + hypot(stretched[0], stretched[1]));
}

// A reflection about a normal tilted towards the viewer by the slopes `tilt`. Its alphas are
// `wide_x` and `wide_y` times the surface's.
closure color tilted_reflection(Frame frame, Microsurface surface, vector wi, vector tilt,
                                float wide_x, float wide_y, string ndf)
{
  vector n = normalize(tilt + vector(0, 0, 1));
  return microfacet(ndf, to_world(frame, corrected_normal(n, wi, vector(0, 0, 1))), frame.x,
                    min(wide_x * surface.alpha_x, 1), min(wide_y * surface.alpha_y, 1), 1, 0);
}

// The table's values for a surface and a view, with the energy itself in ANISOTROPIC_ENERGY.
void anisotropic_shape(Microsurface surface, vector wi, output float v[ANISOTROPIC_VALUES])
{
  vector s = stretch(surface, wi);
  float x2 = s[0] * s[0], y2 = s[1] * s[1];
  float c = stretched_cosine(s);
  anisotropic_values(surface.beckmann, 2 * surface.alpha_x - 1,
                     2 * log10(surface.alpha_y / surface.alpha_x) + 1, 2 * c - 1,
                     (1 - c) * (x2 - y2) / (x2 + y2), v);
  // Polynomials are off by a few thousandths, also where almost nothing is left.
  v[ANISOTROPIC_ENERGY] = min(v[ANISOTROPIC_ENERGY] * (surface.beckmann ? c : sqrt(c)),
                              missing_energy_bound(surface, wi));
}

closure color anisotropic_further_bounces(Frame frame, Microsurface surface, FresnelRange fresnel,
                                          vector wi, int max_bounces)
{
  float v[ANISOTROPIC_VALUES];
  anisotropic_shape(surface, wi, v);

  // One Fresnel factor for both facets of bounce 2, one for those of all others.
  color second = mean_fresnel(fresnel, v[ANISOTROPIC_FRESNEL_2]);
  color later = later_bounces(mean_fresnel(fresnel, v[ANISOTROPIC_FRESNEL_LATER]),
                              v[ANISOTROPIC_REST], max_bounces);
  float share = v[ANISOTROPIC_SHARE_2];
  color kept = v[ANISOTROPIC_ENERGY] * (share * second * second + (1 - share) * later);

  color ramp[KNOTS];
  for (int k = 0; k < KNOTS; ++k) {
    float z = k / (KNOTS - 1.0);
    ramp[k] = z * (2 * (1 - z) * v[ANISOTROPIC_RAMP_HALFWAY] + z * v[ANISOTROPIC_RAMP_POLE]) * kept;
  }
  vector s = stretch(surface, wi);
  float steep = stretched_cosine(s) / s[2];
  vector tilt = steep * vector(surface.alpha_x * s[0], surface.alpha_y * s[1], 0);
  return v[ANISOTROPIC_LOBE_1] * kept
             * tilted_reflection(frame, surface, wi, v[ANISOTROPIC_TILT_1] * tilt,
                                 v[ANISOTROPIC_WIDTH_X_1], v[ANISOTROPIC_WIDTH_Y_1],
                                 distribution_name(surface))
         + v[ANISOTROPIC_LOBE_2] * kept
               * tilted_reflection(frame, surface, wi, v[ANISOTROPIC_TILT_2] * tilt,
                                   v[ANISOTROPIC_WIDTH_X_2], v[ANISOTROPIC_WIDTH_Y_2], "beckmann")
         + ramp_lobe(frame.z, ramp, 1 / (1 - v[ANISOTROPIC_ENERGY]));
}

#endif
