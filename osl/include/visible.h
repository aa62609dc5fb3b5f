// SPDX-License-Identifier: GPL-3.0-or-later
// Samples visible normals (VNDF), Dvis(v, m) = <v, m> D(m) / sigma(v), for v on either side of the
// horizon.
#ifndef MICROBOUNCE_VISIBLE_H
#define MICROBOUNCE_VISIBLE_H

#include "../tables/special.h"
#include "ndf.h"
#include "smith.h"

// GGX: a micronormal of alpha 1 visible from the unit vector `w` is h = c + w, with c uniform on
// the spherical cap c.z > -w.z (Dupuy and Benyoub 2023). `1 + w.z` and `h.z` avoid the difference
// that cancels if w points down.
vector ggx_visible_normal(vector w, vector u)
{
  float width = (w[2] >= 0) ? 1 + w[2] : (w[0] * w[0] + w[1] * w[1]) / (1 - w[2]);
  float depth = u[0] * width;
  float radius = sqrt(max(depth * (2 - depth), 0));
  float sine, cosine;
  sincos(M_2PI * u[1], sine, cosine);
  return vector(radius * cosine + w[0], radius * sine + w[1], (1 - u[0]) * width);
}

// Beckmann seen from below the horizon: only slopes x > a are visible along the incidence, with
// density (x - a) exp(-x^2); a >= 0 is the cotangent of the stretched direction. Returns the y = x
// - a that solves tail(y) = u tail(0). The tail is the integral from y on, without its factor
// exp(-a^2) / 2, which would underflow. Halley's method, started at the mode. Density and tail are
// log-concave, so the denominator of a step stays above 1/2.
float beckmann_tail_slope(float a, float u)
{
  float root_pi = sqrt(M_PI);
  float target = u * root_pi * ierfcx(a);
  float y = 1 / (a + sqrt(a * a + 2));
  for (int i = 0; i < 16; ++i) {
    float x = a + y;
    float gauss = exp(-y * (y + 2 * a));
    float tail = gauss * (y + a * root_pi * ierfcx(x)) / x;
    float newton = (tail - target) / (2 * y * gauss);
    float step = newton / max(1 + newton * (0.5 / y - x), 0.5);
    y = max(y + step, 0.01 * y);
    if (abs(step) < 1e-5 * y)
      break;
  }
  return y;
}

// Beckmann: a micronormal of alpha 1, not normalised, visible from the unit vector `w`. sigma(w) =
// w.z + sigma(-w) splits the density <w, m> D(m) in two parts that are easy to sample. The first
// is the whole distribution, mirrored to the side facing w as often as that is the more visible
// one. The second, with probability `steep`, has the slopes so steep that -w sees them mirrored.
// From below, only the second is left.
vector beckmann_visible_normal(vector w, float steep, vector u)
{
  float cosine = abs(w[2]);
  float sine = hypot(w[0], w[1]);
  float along, across;
  if (u[2] < steep || steep == 1) {  // u[2] may be 1 as well
    float a = cosine / max(sine, 1e-4 * cosine);
    along = a + beckmann_tail_slope(a, u[0]);
    across = sqrt(-log(max(u[1], 1e-12))) * cos(M_2PI * u[2] / steep);
  }
  else {
    float radius = sqrt(-log(max(u[0], 1e-12)));
    sincos(M_2PI * u[1], across, along);
    across *= radius;
    along *= radius;
    if (along < 0 && (u[2] - steep) * cosine < -along * sine * (1 - steep))
      along = -along;
  }
  vector azimuth = (sine > 0) ? vector(w[0] / sine, w[1] / sine, 0) : vector(1, 0, 0);
  return vector(along * azimuth[0] - across * azimuth[1],
                along * azimuth[1] + across * azimuth[0], 1);
}

// A micronormal visible from `arrival`: a unit vector with z >= 0. The numbers in u are uniform in
// [0, 1]; GGX uses two of them.
vector sample_visible_normal(Microsurface surface, Incidence arrival, vector u)
{
  vector w = arrival.stretched;
  vector m;
  if (surface.beckmann)
    m = beckmann_visible_normal(w, (arrival.v[2] > 0) ? arrival.excess / arrival.area : 1, u);
  else
    m = ggx_visible_normal(w, u);
  return normalize(stretch(surface, m));
}

#endif
