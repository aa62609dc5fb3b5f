// SPDX-License-Identifier: GPL-3.0-or-later
// The further bounces of anisotropic metal without noise: two reflections about normals that are
// tilted in the plane of the stretched view, and a ramp about the normal.
#ifndef MICROBOUNCE_FITTED_ANISOTROPIC_H
#define MICROBOUNCE_FITTED_ANISOTROPIC_H

#include "../tables/anisotropic_lobes.h"
#include "fitted.h"
#include "frame.h"
#include "ramp.h"

// 1 along the normal, 0 along the horizon, as a surface of alpha 1 would see it.
float stretched_cosine(vector stretched)
{
  return stretched[2] / (stretched[2] + hypot(stretched[0], stretched[1]));
}

// A reflection about a normal that is tilted towards the viewer by the slopes `tilt`, of widths
// relative to the surface's.
closure color tilted_reflection(Frame frame, Microsurface surface, vector wi, vector tilt,
                                float wide_x, float wide_y, string ndf)
{
  vector n = normalize(tilt + vector(0, 0, 1));
  return microfacet(ndf, to_world(frame, corrected_normal(n, wi, vector(0, 0, 1))), frame.x,
                    min(wide_x * surface.alpha_x, 1), min(wide_y * surface.alpha_y, 1), 1, 0);
}

// The table's values for a surface and a view, of which the first becomes the energy.
void anisotropic_shape(Microsurface surface, vector wi, output float v[ANISOTROPIC_VALUES])
{
  vector s = stretch(surface, wi);
  float x2 = s[0] * s[0], y2 = s[1] * s[1];
  float c = stretched_cosine(s);
  anisotropic_values(surface.beckmann, 2 * surface.alpha_x - 1,
                     2 * log10(surface.alpha_y / surface.alpha_x) + 1, 2 * c - 1,
                     (1 - c) * (x2 - y2) / (x2 + y2), v);
  // Polynomials miss by a few thousandths, where next to nothing is left too.
  v[0] = min(v[0] * (surface.beckmann ? c : sqrt(c)), missing_energy_bound(surface, wi));
}

closure color anisotropic_further_bounces(Frame frame, Microsurface surface, FresnelRange fresnel,
                                          vector wi, int max_bounces)
{
  float v[ANISOTROPIC_VALUES];
  anisotropic_shape(surface, wi, v);

  // One Fresnel factor for both facets of bounce 2, one for those of all others.
  color second = mean_fresnel(fresnel, v[12]);
  color later = later_bounces(mean_fresnel(fresnel, v[13]), v[14], max_bounces);
  color kept = v[0] * (v[11] * second * second + (1 - v[11]) * later);

  color ramp[KNOTS];
  for (int k = 0; k < KNOTS; ++k) {
    float z = k / (KNOTS - 1.0);
    ramp[k] = z * (2 * (1 - z) * v[3] + z * v[4]) * kept;
  }
  vector s = stretch(surface, wi);
  float steep = stretched_cosine(s) / s[2];
  vector tilt = steep * vector(surface.alpha_x * s[0], surface.alpha_y * s[1], 0);
  return v[1] * kept
             * tilted_reflection(frame, surface, wi, v[5] * tilt, v[6], v[7],
                                 distribution_name(surface))
         + v[2] * kept
               * tilted_reflection(frame, surface, wi, v[8] * tilt, v[9], v[10], "beckmann")
         + ramp_lobe(frame.z, ramp, 1 / (1 - v[0]));
}

#endif
