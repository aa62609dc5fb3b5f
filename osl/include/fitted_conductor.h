// SPDX-License-Identifier: GPL-3.0-or-later
// Metal without noise: the first bounce is Cycles' own closure, further ones are a ramp about the
// normal and a reflection, or go the way of the first where the surface is not seen.
#ifndef MICROBOUNCE_FITTED_CONDUCTOR_H
#define MICROBOUNCE_FITTED_CONDUCTOR_H

#include "../tables/conductor_lobes.h"
#include "fitted.h"
#include "fitted_anisotropic.h"
#include "ramp.h"
#include "reflection.h"

// Aspects (1 - alpha_y / alpha_x) up to this pass from isotropic closures to anisotropic ones.
#define LARGEST_BLENDED_ASPECT 0.1

// Cosine of the lowest direction to which the reflection of bounce 2 mirrors the view.
#define LOWEST_MIRROR 0.077

// A reflection of widths `along` the plane of incidence and `across` it, about the normal that
// mirrors the view to where its sine is `ratio` times as large.
closure color aimed_reflection(Frame frame, Microsurface surface, vector wi, color weight,
                               float ratio, float along, float across)
{
  float sine2 = wi[0] * wi[0] + wi[1] * wi[1];
  float z = sqrt(max(1 - ratio * ratio * sine2, LOWEST_MIRROR * LOWEST_MIRROR));
  vector h = normalize(vector((1 - ratio) * wi[0], (1 - ratio) * wi[1], wi[2] + z));
  vector sideways = (sine2 > 0) ? normalize(vector(-wi[1], wi[0], 0)) : vector(0, 1, 0);
  return weight * microfacet(distribution_name(surface), to_world(frame, h),
                             to_world(frame, cross(sideways, h)), min(along, 1), min(across, 1),
                             1, 0);
}

// That of the isotropic surface which stands for a nearly isotropic one.
float mean_alpha(Microsurface surface)
{
  return sqrt(surface.alpha_x * surface.alpha_y);
}

// What the further bounces of an isotropic metal send, wherever to.
struct FurtherBounces {
  float energy;  // of white metal
  float share;   // bounce 2's in that
  color second;  // one Fresnel factor for both facets of bounce 2
  color later;   // one for those of all others
  color series;  // factor of all bounces after the third
  float cosine;  // part that is a cosine lobe where the surface is not seen
};

FurtherBounces isotropic_further_bounces(Microsurface surface, FresnelRange fresnel, vector wi,
                                         int max_bounces)
{
  float energy[1], c[5];
  conductor_energy(surface.beckmann, mean_alpha(surface), wi[2], energy);
  conductor_colour(surface.beckmann, mean_alpha(surface), wi[2], c);
  FurtherBounces further;
  further.energy = energy[0];
  further.share = c[0];
  further.second = mean_fresnel(fresnel, c[1]);
  further.later = mean_fresnel(fresnel, c[2]);
  further.series = successive_bounces(further.later, c[3], max_bounces - 2);
  further.cosine = c[4];
  return further;
}

closure color seen_further_bounces(Frame frame, Microsurface surface, vector wi,
                                   FurtherBounces further)
{
  float alpha = mean_alpha(surface);
  float v[22];
  conductor_shape(surface.beckmann, alpha, wi[2], v);
  color ramp[KNOTS];
  for (int k = 0; k < KNOTS; ++k)
    ramp[k] = color(v[k] + v[KNOTS + k]);
  color fitted = ramp_energy(ramp) + (v[16] + v[17]) * v[18];
  float scale = further.energy / fitted[0];

  color second = scale * further.second * further.second;
  color later = scale * further.later * further.later * further.later * further.series;
  for (int k = 0; k < KNOTS; ++k)
    ramp[k] = second * v[k] + later * v[KNOTS + k];
  // Cycles picks the first bounce as if it lost nothing.
  return aimed_reflection(frame, surface, wi, second * v[16] + later * v[17], v[19],
                          alpha * v[20], alpha * v[21])
         + ramp_lobe(frame.z, ramp, 1 / (1 - further.energy));
}

// All bounces of a surface that is not seen, where lobes widen nothing that is not wide already: of
// the further ones what is a ramp elsewhere is a cosine, and the rest goes the way of the first.
closure color unseen_conductor(Frame frame, Microsurface surface, Facet facet,
                               FurtherBounces further)
{
  // Over a facet's factor, which the first bounce has as well.
  color kept = further.energy
               * (further.share * further.second
                  + (1 - further.share) * further.later * further.later * further.series);
  return whole_reflection(frame, surface, facet,
                          1 + (1 - further.cosine) / (1 - further.energy) * kept)
         + (further.cosine * further.second * kept) * diffuse(frame.z);
}

// Surfaces that are nearly isotropic have the closures of both kinds, so that nothing jumps.
closure color fitted_conductor(Frame frame, Microsurface surface, Facet facet, vector wi,
                               Accuracy accuracy)
{
  int bounces = accuracy.max_bounces;
  if (!has_further_bounces(surface, facet, wi, accuracy))
    return whole_reflection(frame, surface, facet, 1);
  float anisotropic = min((1 - surface.alpha_y / surface.alpha_x) / LARGEST_BLENDED_ASPECT, 1);
  FresnelRange fresnel = fresnel_range(facet.metal);
  closure color lobes = 0;
  if (anisotropic < 1) {
    FurtherBounces further = isotropic_further_bounces(surface, fresnel, wi, bounces);
    if (!is_seen())
      return unseen_conductor(frame, surface, facet, further);
    lobes = seen_further_bounces(frame, surface, wi, further);
  }
  if (!surface.isotropic)
    lobes = (1 - anisotropic) * lobes
            + anisotropic * anisotropic_further_bounces(frame, surface, fresnel, wi, bounces);
  // In another order Cycles' samples spread less evenly over the closures, and make more noise.
  return lobes + whole_reflection(frame, surface, facet, 1);
}

#endif
