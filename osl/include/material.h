// SPDX-License-Identifier: GPL-3.0-or-later
// What a microfacet does with a path: mirror, glass or matte. Directions are in the frame of the
// path's side. Below the surface that is the common frame with all directions negated: z points
// away from the surface on both sides, and a facet's normal has the same components.
#ifndef MICROBOUNCE_MATERIAL_H
#define MICROBOUNCE_MATERIAL_H

#include "fresnel.h"

#define CONDUCTOR 0
#define DIELECTRIC 1
#define DIFFUSE 2

struct Material {
  int kind;
  Conductor metal;  // of a conductor
  float ior;        // of a dielectric: index below the surface over index above
  color tint;       // of a dielectric or a diffuse facet: the factor of each event
};

// Index beyond a dielectric facet over that on the path's side.
float relative_ior(Material material, int below)
{
  return below ? 1 / material.ior : material.ior;
}

// The factor on a path's weight, for the cosine between ray and facet.
color scattering_factor(Material material, float cosine)
{
  return (material.kind == CONDUCTOR) ? conductor_fresnel(material.metal, cosine) : material.tint;
}

// Snell's law, in the frame of the other side. Past the critical angle the ray grazes.
vector refracted(vector v, vector m, float cosine, float eta)
{
  float ratio = 1 / eta;
  float beyond = sqrt(max(1 - (1 - cosine * cosine) * ratio * ratio, 0));
  return normalize(ratio * v + (beyond - cosine * ratio) * m);
}

// A direction with the density <o, m> / pi: towards a point on the unit sphere that touches the
// facet at m's foot.
vector cosine_direction(vector m, float u0, float u1)
{
  float z = 1 - 2 * u0;
  float radius = sqrt(max(1 - z * z, 0));
  float sine, cosine;
  sincos(M_2PI * u1, sine, cosine);
  vector o = m + vector(radius * cosine, radius * sine, z);
  return (dot(o, o) > 1e-12) ? normalize(o) : m;
}

// Where a facet of normal `m` sends a path from `v`, in the frame of the side it is on afterwards,
// and whether it `crossed` the surface. u0 and u1 are uniform in [0, 1]; mirrors use neither.
vector scattered(Material material, vector v, vector m, int below, float cosine, float u0, float u1,
                 output int crossed)
{
  crossed = 0;
  if (material.kind == DIFFUSE)
    return cosine_direction(m, u0, u1);
  if (material.kind == DIELECTRIC) {
    float eta = relative_ior(material, below);
    if (u0 >= dielectric_fresnel(eta, cosine)) {
      crossed = 1;
      return refracted(v, m, cosine, eta);
    }
  }
  return 2 * cosine * m - v;
}

#endif
