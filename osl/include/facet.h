// SPDX-License-Identifier: GPL-3.0-or-later
// What a microfacet does with a path: mirror, glass or matte. Directions are given in the frame of
// the side of the surface that the path is on; below it that is the common frame with all
// directions negated, so that z points away from the surface on both sides and a facet's normal has
// the same components.
#ifndef MICROBOUNCE_FACET_H
#define MICROBOUNCE_FACET_H

#include "fresnel.h"

#define CONDUCTOR 0
#define DIELECTRIC 1
#define DIFFUSE 2

struct Facet {
  int kind;
  Conductor metal;  // of a conductor
  float ior;        // of a dielectric: index below the surface over the index above it
  color tint;       // of a dielectric or a diffuse facet: factor of every event
};

// Index beyond a dielectric facet over that on the path's side.
float relative_ior(Facet facet, int below)
{
  return below ? 1 / facet.ior : facet.ior;
}

// The factor on a path's weight, for the cosine between ray and facet.
color facet_weight(Facet facet, float cosine)
{
  return (facet.kind == CONDUCTOR) ? conductor_fresnel(facet.metal, cosine) : facet.tint;
}

// Snell's law, in the frame of the other side. Past the critical angle the ray grazes.
vector refracted(vector v, vector m, float cosine, float eta)
{
  float ratio = 1 / eta;
  float beyond = sqrt(max(1 - (1 - cosine * cosine) * ratio * ratio, 0));
  return normalize(ratio * v + (beyond - cosine * ratio) * m);
}

// A direction with the density <o, m> / pi: towards a point of the unit sphere that touches the
// facet.
vector cosine_direction(vector m, float u0, float u1)
{
  float z = 1 - 2 * u0;
  float radius = sqrt(max(1 - z * z, 0));
  float sine, cosine;
  sincos(M_2PI * u1, sine, cosine);
  vector o = m + vector(radius * cosine, radius * sine, z);
  return (dot(o, o) > 1e-12) ? normalize(o) : m;
}

// Where a facet of normal `m` sends a path from `v`, in the frame of the side that it is on
// afterwards, and whether it `crossed` the surface. Numbers u uniform in [0, 1]; mirrors need none.
vector scattered(Facet facet, vector v, vector m, int below, float cosine, float u0, float u1,
                 output int crossed)
{
  crossed = 0;
  if (facet.kind == DIFFUSE)
    return cosine_direction(m, u0, u1);
  if (facet.kind == DIELECTRIC) {
    float eta = relative_ior(facet, below);
    if (u0 >= dielectric_fresnel(eta, cosine)) {
      crossed = 1;
      return refracted(v, m, cosine, eta);
    }
  }
  return 2 * cosine * m - v;
}

#endif
