// SPDX-License-Identifier: GPL-3.0-or-later
// Smith's masking and shadowing in terms of the projected area sigma, which is finite and
// non-negative for every direction: sigma(w) = (1 + Lambda(w)) w.z, G1dist(w) = |w.z| / sigma(w)
// (Wang et al. 2022, supplement, eq. 3). Directions may lie on either side of the horizon: inside
// the microgeometry a path also travels upwards, and is then received from below.
#ifndef MICROBOUNCE_SMITH_H
#define MICROBOUNCE_SMITH_H

#include "../tables/ierfcx.h"
#include "ndf.h"

// The part of sigma that is the same for w and -w: sigma(-w), that is Lambda(w) w.z, for w above.
float projected_excess(Microsurface surface, vector w)
{
  vector s = stretch(surface, w);
  float t2 = s[0] * s[0] + s[1] * s[1];
  float cosine = abs(w[2]);
  if (t2 <= 0)
    return 0;
  if (surface.beckmann) {
    float t = sqrt(t2);
    float a = cosine / t;
    return (a < 9) ? 0.5 * t * exp(-a * a) * ierfcx(a) : 0;  // below 1e-36 from a = 9 on
  }
  return 0.5 * t2 / (sqrt(cosine * cosine + t2) + cosine);
}

// A direction from which a vertex receives the path, and what its samples share.
struct Incidence {
  vector v;      // minus the direction of travel, unit, local frame
  float excess;  // sigma(-|v|)
  float area;    // sigma(v) = integral of <v, m> D(m) dm over the micronormals
};

Incidence incidence(Microsurface surface, vector v)
{
  Incidence arrival;
  arrival.v = v;
  arrival.excess = projected_excess(surface, v);
  arrival.area = max(v[2], 0) + arrival.excess;
  return arrival;
}

// The chance that a path sent to `o` leaves without another bounce, for the height-correlated model
// (eqs. 12, 14, 16 and 17): sigma(v) o.z / (sigma(v) o.z + sigma(-o) |v.z|).
float exit_probability(Microsurface surface, Incidence arrival, vector o)
{
  if (o[2] <= 0)
    return 0;
  float leaves = arrival.area * o[2];
  float stays = projected_excess(surface, o) * abs(arrival.v[2]);
  return (stays > 0) ? leaves / (leaves + stays) : 1;
}

// An upper bound of the energy that a white surface seen from `wi` sends on after its first bounce.
// GGX: like alpha^2, growing towards grazing views. Beckmann: like the chance of a slope that
// mirrors wi to the horizon. The factors keep it above the oracle's energies and, where it is
// small, within a few times of them (blender_tests/osl/test_smith.py).
float missing_energy_bound(Microsurface surface, vector wi)
{
  float alpha = max(surface.alpha_x, surface.alpha_y);
  if (surface.beckmann) {
    float sine = sqrt(max(1 - wi[2] * wi[2], 0));
    float slope = wi[2] / (1 + sine);
    return min(1.1 * exp(-(0.7 + 0.4 * sine) * slope * slope / max(alpha * alpha, 1e-12)), 1);
  }
  float lost = 1.4 * alpha * alpha, seen = wi[2] * wi[2];
  return (lost < seen) ? lost / seen : 1;
}

#endif
