// SPDX-License-Identifier: GPL-3.0-or-later
// Smith's masking and shadowing by the projected area sigma, which is finite and non-negative for
// every direction: sigma(w) = (1 + Lambda(w)) w.z, G1dist(w) = |w.z| / sigma(w) (Wang et al. 2022,
// supplement, eq. 3). Directions may lie below the horizon: inside the microgeometry a path also
// travels upwards, and the next vertex receives it from below.
#ifndef MICROBOUNCE_SMITH_H
#define MICROBOUNCE_SMITH_H

#include "../tables/special.h"
#include "ndf.h"

// The part of sigma that w and -w share. For w above the horizon it is sigma(-w) = Lambda(w) w.z.
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

// The direction from which a vertex receives the path, and what its samples share.
struct Incidence {
  vector v;          // minus the direction of travel, unit, local frame
  vector stretched;  // as a surface of alpha 1 sees it, unit
  float excess;      // sigma(-|v|)
  float area;        // sigma(v) = integral of <v, m> D(m) dm over the micronormals
};

Incidence incidence(Microsurface surface, vector v)
{
  Incidence arrival;
  arrival.v = v;
  arrival.stretched = normalize(stretch(surface, v));
  arrival.excess = projected_excess(surface, v);
  arrival.area = max(v[2], 0) + arrival.excess;
  return arrival;
}

// log(1 + z) / z for z >= 0; 1 + z would lose the digits of a small z.
float log1p_over(float z)
{
  return (z > 0.01) ? log(1 + z) / z : 1 - z * (0.5 - z * (1 / 3.0 - 0.25 * z));
}

// 1 - exp(x); near 0 OSL's expm1 has steps of 6e-8.
float one_minus_exp(float x)
{
  return (abs(x) > 0.01) ? -expm1(x) : -x * (1 + x * (0.5 + x * (1 / 6.0 + x / 24)));
}

// log(1 - x) for x in [0, 1] and `rest` = 1 - x, as -log(1 + x / rest). That keeps the digits of a
// small x, and of a small rest that is known better than as a difference.
float log_of_rest(float x, float rest)
{
  float odds = x / max(rest, 1e-37);
  return -odds * log1p_over(odds);
}

// A height is the logarithm of its distribution function u in (0, 1], seen from the path's side of
// the surface: 0 at the top.

// The same height seen from the other side: log(1 - u).
float height_from_below(float log_u)
{
  return log_of_rest(exp(log_u), one_minus_exp(log_u));
}

// The height where a path from `arrival` first meets the surface: u has density a u^(a-1) with
// a = |1 + Lambda(v)| = sigma(v) / |v.z| (eq. 15).
float height_met(Incidence arrival, float number)
{
  return log(max(number, 1e-37)) * abs(arrival.v[2]) / max(arrival.area, 1e-37);
}

// exp() of more comes near the largest float.
#define LARGEST_EXPONENT 80

// Where a path that stays, at height `log_u` towards `o`, meets the surface again (Heitz et al.
// 2016). |Lambda| = sigma(-o) / |o.z|. Downwards: u U^(1/|Lambda|). Upwards: u / T^(1/Lambda) with
// T uniform between u^Lambda, the chance to escape, and 1. Written from the top, which keeps
// digits there: 1 / (1 + (1 - U) (u^-Lambda - 1))^(1/Lambda).
float next_height(Microsurface surface, vector o, float log_u, float number)
{
  float depth = abs(o[2]);
  float back = max(-o[2], 0) + projected_excess(surface, o);
  if (!(back > 0))
    return log_u;
  if (o[2] <= 0)
    return log_u + log(max(number, 1e-37)) * depth / back;
  float steps = -log_u * back / depth;
  float rest = max(1 - number, 0);
  if (steps > LARGEST_EXPONENT)  // almost certain to stay: T = 1 - U
    return min(log_u - log(max(rest, 1e-37)) * depth / back, 0);
  float odds = -rest * one_minus_exp(steps);
  return -odds * log1p_over(odds) * depth / back;
}

// The chance that a path at height `log_u` towards `o` leaves: u^Lambda(o).
float escape_chance(Microsurface surface, vector o, float log_u)
{
  return (o[2] > 0) ? exp(log_u * projected_excess(surface, o) / o[2]) : 0;
}

// The chance that a path reflected to `o` leaves without another bounce; none below the horizon.
// Height-correlated (eqs. 12, 14, 16 and 17): sigma(v) o.z / (sigma(v) o.z + sigma(-o) |v.z|).
// Height-uncorrelated (eqs. 3 and 19-24): G1dist(o) = o.z / sigma(o).
float exit_probability(Microsurface surface, Incidence arrival, vector o)
{
  if (o[2] <= 0)
    return 0;
  float excess = projected_excess(surface, o);
  if (surface.model == UNCORRELATED)
    return o[2] / (o[2] + excess);
  float leaves = arrival.area * o[2];
  float stays = excess * abs(arrival.v[2]);
  return (stays > 0) ? leaves / (leaves + stays) : 1;
}

// The chance that a path refracted to `o`, in the frame of the other side, leaves there without
// another bounce, height-correlated. The height has density a u^(a-1) with a = |1 + Lambda(v)|,
// and the part (1 - u)^Lambda(o) escapes. That makes a B(a, 1 + Lambda(o)) = (x + y - 1) B(x, y)
// with x = a + 1 and y = 1 + Lambda(o), by Stirling's formula. p = 1 / x and q = 1 / y; at grazing
// directions x and y end at 1e18.
float crossing_probability(Microsurface surface, Incidence arrival, vector o)
{
  if (o[2] <= 0)
    return 0;
  float depth = abs(arrival.v[2]);
  float p = max(depth / (arrival.area + depth), 1e-18), x = 1 / p;
  float q = max(o[2] / (o[2] + projected_excess(surface, o)), 1e-18), y = 1 / q;
  float both = p + q;
  float exponent = y * log1p_over(p * y) + x * log1p_over(q * x) - 0.5 * log(M_2PI * both)
                   - stirling_remainder(p) - stirling_remainder(q)
                   + stirling_remainder(p * q / both);
  return min((x + y - 1) * exp(-exponent), 1);
}

// The chance that a path from `arrival` leaves towards `o`, in the frame of the side it is then
// on, if its height is not known.
float leave_probability(Microsurface surface, Incidence arrival, vector o, int crossed)
{
  if (crossed && surface.model != UNCORRELATED)
    return crossing_probability(surface, arrival, o);
  return exit_probability(surface, arrival, o);
}

// An upper bound of the energy that a white surface seen from `wi` keeps after its first bounce.
// GGX: like alpha^2, growing towards grazing views. Beckmann: like the chance of a slope that
// mirrors wi to the horizon. The factors keep it above the oracle's energies, and within a few
// times of small ones (blender_tests/osl/test_smith.py).
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
