// SPDX-License-Identifier: GPL-3.0-or-later
// Brings what comes into a shader to its legal range. Values are clamped only here.
#ifndef MICROBOUNCE_INPUTS_H
#define MICROBOUNCE_INPUTS_H

#include "accuracy.h"
#include "frame.h"
#include "ndf.h"

// `value` limited to [low, high]; `fallback` if it is not a finite number.
float legal(float value, float low, float high, float fallback)
{
  return isfinite(value) ? clamp(value, low, high) : fallback;
}

color legal(color value, float low, float high, color fallback)
{
  return color(legal(value[0], low, high, fallback[0]), legal(value[1], low, high, fallback[1]),
               legal(value[2], low, high, fallback[2]));
}

// The unit vector along `value`, or `fallback` where it has no direction.
vector direction(vector value, vector fallback)
{
  float squared = dot(value, value);
  return (isfinite(squared) && squared > 0) ? normalize(value) : fallback;
}

// Where roughness becomes alpha, as in Cycles' Metallic BSDF: alpha = roughness^2, spread by the
// aspect and limited to 1.
Microsurface microsurface(float roughness, float anisotropy, int distribution, int model)
{
  float alpha = legal(roughness, 0, 1, 0.5);
  alpha *= alpha;
  float aspect = sqrt(1 - 0.9 * legal(anisotropy, 0, 1, 0));
  Microsurface surface;
  surface.alpha_x = min(alpha / aspect, 1);
  surface.alpha_y = alpha * aspect;
  // OSL works out the first comparison as a render starts, whatever the roughness, but no
  // isfinite().
  surface.isotropic = anisotropy <= 0 || surface.alpha_x == surface.alpha_y;
  surface.beckmann = distribution == BECKMANN;
  surface.model = clamp(model, CORRELATED, HEIGHT_TRACKED);
  return surface;
}

// The local frame: z along `n`, x along the tangent if the surface is anisotropic, else anywhere.
Frame oriented_frame(Microsurface surface, vector n, vector fallback, vector given, float rotation,
                     vector view)
{
  vector z = visible_normal(direction(n, fallback), view);
  if (!is_left_alone(z, view, Ng))
    z = corrected_normal(z, view, bending_ground());
  if (surface.isotropic)
    return any_frame(z);
  vector tangent = direction(given, direction(dPdu, any_tangent(z)));
  float turns = legal(rotation, -1e3, 1e3, 0);
  if (turns != 0)
    tangent = rotate(tangent, turns * M_2PI, point(0), point(z));
  return shading_frame(z, tangent);
}

Accuracy legal_accuracy(int quality, int max_bounces, int only, float tolerance, int walks,
                        float kernel)
{
  Accuracy accuracy;
  accuracy.quality = clamp(quality, QUALITY_SINGLE, QUALITY_EXACT);
  accuracy.max_bounces = clamp(max_bounces, 1, 64);
  accuracy.only = clamp(only, 0, accuracy.max_bounces);
  accuracy.tolerance = legal(tolerance, 0, 1, 0.001);
  accuracy.walks = clamp(walks, 1, 16);
  accuracy.kernel = legal(kernel, 0.05, 1, 0.3);
  return accuracy;
}

#endif
