// SPDX-License-Identifier: GPL-3.0-or-later
// Exits of walks as Cycles' closures: smooth lobes, which take part in light sampling, or singular
// ones, which go exactly there. Cycles' closures know the view alone and have no density for an
// arbitrary exit, so each is given a made-up normal that turns the view to the exit.
#ifndef MICROBOUNCE_EXITS_H
#define MICROBOUNCE_EXITS_H

#include "facet.h"
#include "frame.h"
#include "ndf.h"
#include "stdcycles.h"

// Widest exit relative to the surface: a wider one blurs narrow lobes, a narrower one is noise.
#define KERNEL_PER_ALPHA 0.5

// Indices of refraction of made-up facets. A high one sends the ray along the facet's normal,
// whatever the view; a low one lets the facet face the viewer. Exits that turn the path by more
// than these cosines reach are left to a lobe meant for hair, which points anywhere but has long
// tails (Cauchy).
#define STEEP_IOR 1000
#define FLAT_IOR 0.05
#define SMALLEST_STEEP_TURN 0.35
#define SMALLEST_FLAT_TURN 0.45
#define HAIR_PER_KERNEL 0.5

// The part that lies on the exit's own side of the horizon of a lobe whose cosine to the normal has
// the Gaussian density exp(-(x - z)^2 / spread^2) about z.
float fraction_on_side(float z, float spread)
{
  return (z < 4 * spread) ? 0.5 * (1 + erf(z / spread)) : 1;
}

// That part of a mirrored Beckmann lobe: to first order a micronormal of slopes s about h moves the
// cosine o.z by 2 g.s, and the slopes are Gaussian with variance alpha^2 / 2.
float fraction_above_horizon(vector wi, float o_z, Frame lobe, float alpha_x, float alpha_y)
{
  float along = dot(wi, lobe.z);
  float gx = alpha_x * (dot(wi, lobe.x) * lobe.z[2] + along * lobe.x[2]);
  float gy = alpha_y * (dot(wi, lobe.y) * lobe.z[2] + along * lobe.y[2]);
  return fraction_on_side(o_z, 2 * hypot(gx, gy));
}

// A reflected exit towards `o`: a Beckmann microfacet lobe about the half vector. Its single bounce
// loses next to nothing to masking at these widths; what falls below the horizon is given back to
// the rest.
closure color smooth_reflection(Frame frame, vector wi, vector o, float alpha_x, float alpha_y,
                                color weight)
{
  Frame lobe = shading_frame(normalize(wi + o), vector(1, 0, 0));
  float above = fraction_above_horizon(wi, o[2], lobe, alpha_x, alpha_y);
  return (weight / above) * microfacet("beckmann", to_world(frame, lobe.z), to_world(frame, lobe.x),
                                       alpha_x, alpha_y, 1, 0);
}

// The hair lobe about `down`, which transmits: its axis lies between view and exit, so that both
// make the same angle with it on opposite sides, and the offset is that angle.
closure color hair_exit(Frame frame, vector wi, vector down, float width)
{
  vector axis = wi + down;
  axis = (dot(axis, axis) > 1e-8) ? normalize(axis) : any_tangent(wi);
  float elevation = asin(clamp(dot(axis, wi), -1, 1));
  return hair_transmission(frame.z, width, width, to_world(frame, axis), elevation);
}

// The facet that refracts the view to `down` with the index `ior`; no facet (length 0) where Cycles
// would bend it, or where the path turns too far.
vector refracting_facet(Frame frame, vector wi, vector down, float turn, output float ior)
{
  ior = STEEP_IOR;
  vector facet = -normalize(wi + ior * down);
  if (turn > SMALLEST_STEEP_TURN && is_left_alone(facet, wi, frame.ground))
    return facet;
  ior = FLAT_IOR;
  facet = normalize(wi + ior * down);
  if (turn > SMALLEST_FLAT_TURN && is_left_alone(facet, wi, frame.ground))
    return facet;
  return vector(0);
}

// A transmitted exit towards `down`, below the horizon, of half-width `width` (rad).
closure color smooth_transmission(Frame frame, vector wi, vector down, float width, color weight)
{
  float ior;
  float turn = -dot(wi, down);
  vector facet = refracting_facet(frame, wi, down, turn, ior);
  if (dot(facet, facet) == 0)
    return weight * hair_exit(frame, wi, down, HAIR_PER_KERNEL * width);
  // With the low index the ray turns by more than the facet does.
  float alpha = (ior < 1) ? ior * sqrt(turn) * width : width;
  float below = fraction_on_side(-down[2], width);
  return (weight / below) * microfacet("beckmann", to_world(frame, facet),
                                       to_world(frame, any_tangent(facet)), alpha, alpha, ior, 1);
}

// An exit towards `o`, in the frame of its side, as a smooth lobe of half-width `kernel` (rad) or
// less: at most `relative` to the surface, but that light from matte facets spreads over all
// directions, whatever the roughness.
closure color smooth_exit(Frame frame, Microsurface surface, Facet facet, float kernel,
                          float relative, vector wi, vector o, int below, color weight)
{
  float widest = (facet.kind == DIFFUSE) ? 1 : relative;
  float alpha_x = min(0.5 * kernel, widest * surface.alpha_x);
  float alpha_y = min(0.5 * kernel, widest * surface.alpha_y);
  if (facet.kind == DIELECTRIC && below)
    return smooth_transmission(frame, wi, -o, min(alpha_x, alpha_y), weight);
  return smooth_reflection(frame, wi, o, alpha_x, alpha_y, weight);
}

// An exit exactly towards `o`: unbiased, but lights are only found by being hit. Exits that turn
// the path by a right angle or more are not within reach of a mirror or a refraction; they take the
// narrowest hair lobe.
closure color singular_exit(Frame frame, Facet facet, vector wi, vector o, int below)
{
  if (facet.kind == DIELECTRIC && below) {
    float ior;
    vector n = refracting_facet(frame, wi, -o, dot(wi, o), ior);
    if (dot(n, n) == 0)
      return hair_exit(frame, wi, -o, 0.001);
    return refraction(to_world(frame, n), ior);
  }
  return reflection(to_world(frame, normalize(wi + o)));
}

#endif
