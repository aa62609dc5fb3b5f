// SPDX-License-Identifier: GPL-3.0-or-later
// Exits of walks as Cycles' closures: smooth lobes, which take part in light sampling, or singular
// ones. Cycles' closures know only the view and have no density for an arbitrary exit, so each
// gets a made-up normal that turns the view to the exit.
#ifndef MICROBOUNCE_EXITS_H
#define MICROBOUNCE_EXITS_H

#include "material.h"
#include "frame.h"
#include "ndf.h"
#include "stdcycles.h"

// Widest exit relative to the surface. A wider one blurs narrow lobes; a narrower one adds noise.
#define KERNEL_PER_ALPHA 0.5

// Indices of refraction of made-up facets. With a high one the ray follows the facet's normal,
// whatever the view. With a low one the facet faces the viewer. If the turn's cosine is below both
// limits, a lobe meant for hair takes over: it points anywhere, but has long tails (Cauchy).
#define STEEP_IOR 1000
#define FLAT_IOR 0.05
#define SMALLEST_STEEP_TURN 0.35
#define SMALLEST_FLAT_TURN 0.45
#define HAIR_PER_KERNEL 0.5

// The part of a lobe on its exit's own side of the horizon. The lobe's cosine to the normal has
// the Gaussian density exp(-(x - z)^2 / spread^2) about z.
float fraction_on_side(float z, float spread)
{
  return (z < 4 * spread) ? 0.5 * (1 + erf(z / spread)) : 1;
}

// The same part of a mirrored Beckmann lobe. To first order a micronormal of slopes s about h
// moves the cosine o.z by 2 g.s, and the slopes are Gaussian with variance alpha^2 / 2.
float fraction_above_horizon(vector wi, float o_z, Frame lobe, float alpha_x, float alpha_y)
{
  float along = dot(wi, lobe.z);
  float gx = alpha_x * (dot(wi, lobe.x) * lobe.z[2] + along * lobe.x[2]);
  float gy = alpha_y * (dot(wi, lobe.y) * lobe.z[2] + along * lobe.y[2]);
  return fraction_on_side(o_z, 2 * hypot(gx, gy));
}

// A reflected exit towards `o`: a Beckmann microfacet lobe about the half vector. At these widths
// masking takes almost nothing. Light below the horizon is given back to the rest of the lobe.
closure color smooth_reflection(Frame frame, vector wi, vector o, float alpha_x, float alpha_y,
                                color weight)
{
  Frame lobe = shading_frame(normalize(wi + o), vector(1, 0, 0));
  float above = fraction_above_horizon(wi, o[2], lobe, alpha_x, alpha_y);
  return (weight / above) * microfacet("beckmann", to_world(frame, lobe.z), to_world(frame, lobe.x),
                                       alpha_x, alpha_y, 1, 0);
}

// The hair lobe about `down`, which transmits. Its axis lies between view and exit, which make the
// same angle with it on opposite sides. The offset is that angle.
closure color hair_exit(Frame frame, vector wi, vector down, float width)
{
  vector axis = wi + down;
  axis = (dot(axis, axis) > 1e-8) ? normalize(axis) : any_tangent(wi);
  float elevation = asin(clamp(dot(axis, wi), -1, 1));
  return hair_transmission(frame.z, width, width, to_world(frame, axis), elevation);
}

// The facet that refracts the view to `down` with the index `ior`. It has length 0 if Cycles would
// bend it, or if the path turns too far.
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
  // With the low index the ray turns more than the facet.
  float alpha = (ior < 1) ? ior * sqrt(turn) * width : width;
  float below = fraction_on_side(-down[2], width);
  return (weight / below) * microfacet("beckmann", to_world(frame, facet),
                                       to_world(frame, any_tangent(facet)), alpha, alpha, ior, 1);
}

// An exit towards `o`, in the frame of its side, as a smooth lobe. Its half-width (rad) is at most
// `kernel`, and at most `relative` times the surface's. Light from matte facets spreads over all
// directions whatever the roughness, so only `kernel` limits that.
closure color smooth_exit(Frame frame, Microsurface surface, Material material, float kernel,
                          float relative, vector wi, vector o, int below, color weight)
{
  float widest = (material.kind == DIFFUSE) ? 1 : relative;
  float alpha_x = min(0.5 * kernel, widest * surface.alpha_x);
  float alpha_y = min(0.5 * kernel, widest * surface.alpha_y);
  if (material.kind == DIELECTRIC && below)
    return smooth_transmission(frame, wi, -o, min(alpha_x, alpha_y), weight);
  return smooth_reflection(frame, wi, o, alpha_x, alpha_y, weight);
}

// An exit exactly towards `o`: unbiased, but paths find lights only by hitting them. Neither
// mirror nor refraction turns a path by a right angle or more; such exits take the narrowest hair
// lobe.
closure color singular_exit(Frame frame, Material material, vector wi, vector o, int below)
{
  if (material.kind == DIELECTRIC && below) {
    float ior;
    vector n = refracting_facet(frame, wi, -o, dot(wi, o), ior);
    if (dot(n, n) == 0)
      return hair_exit(frame, wi, -o, 0.001);
    return refraction(to_world(frame, n), ior);
  }
  return reflection(to_world(frame, normalize(wi + o)));
}

#endif
