// SPDX-License-Identifier: GPL-3.0-or-later
// Metal without noise. The first bounce is Cycles' own closure; further ones are a ramp about the
// normal and a reflection. On surfaces that the camera does not see, the first closure carries
// them.
#ifndef MICROBOUNCE_FITTED_CONDUCTOR_H
#define MICROBOUNCE_FITTED_CONDUCTOR_H

#include "../tables/conductor_lobes.h"
#include "fitted.h"
#include "fitted_anisotropic.h"
#include "ramp.h"
#include "reflection.h"

// Up to this 1 - alpha_y / alpha_x, closures fade from isotropic to anisotropic ones.
#define LARGEST_BLENDED_ASPECT 0.1

// The lowest cosine to which the reflection of bounce 2 mirrors the view.
#define LOWEST_MIRROR 0.077

// A reflection about the normal that mirrors the view to a sine `ratio` times its own. Its alphas
// are `along` the plane of incidence and `across` it.
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

// The alpha of the isotropic surface that stands for a nearly isotropic one.
float mean_alpha(Microsurface surface)
{
  return sqrt(surface.alpha_x * surface.alpha_y);
}

// What the further bounces of an isotropic metal send in all directions together.
struct FurtherBounces {
  float energy;  // of white metal
  float share;   // bounce 2's part of that energy
  color second;  // the Fresnel factor of both facets of bounce 2
  color later;   // the Fresnel factor of all other facets
  color series;  // factor of all bounces after the third
  float cosine;  // part in a cosine lobe if the camera does not see the surface
};

FurtherBounces isotropic_further_bounces(Microsurface surface, FresnelRange fresnel, vector wi,
                                         int max_bounces)
{
  float energy[1], c[5];
  conductor_energy(surface.beckmann, mean_alpha(surface), wi[2], energy);
  conductor_colour(surface.beckmann, mean_alpha(surface), wi[2], c);
  FurtherBounces further;
  further.energy = energy[0];
  further.share = c[METAL_SHARE_2];
  further.second = mean_fresnel(fresnel, c[METAL_FRESNEL_2]);
  further.later = mean_fresnel(fresnel, c[METAL_FRESNEL_LATER]);
  further.series = successive_bounces(further.later, c[METAL_REST], max_bounces - 2);
  further.cosine = c[METAL_RAMP_PART];
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
    ramp[k] = color(v[METAL_RAMP_2 + k] + v[METAL_RAMP_LATER + k]);
  color fitted = ramp_energy(ramp) + (v[METAL_LOBE_2] + v[METAL_LOBE_LATER]) * v[METAL_LOBE_ENERGY];
  float scale = further.energy / fitted[0];

  color second = scale * further.second * further.second;
  color later = scale * further.later * further.later * further.later * further.series;
  for (int k = 0; k < KNOTS; ++k)
    ramp[k] = second * v[METAL_RAMP_2 + k] + later * v[METAL_RAMP_LATER + k];
  // Cycles picks closures as if the first bounce lost nothing, so the ramp is picked more often.
  color lobe = second * v[METAL_LOBE_2] + later * v[METAL_LOBE_LATER];
  return aimed_reflection(frame, surface, wi, lobe, v[METAL_LOBE_SINE],
                          alpha * v[METAL_LOBE_ALONG], alpha * v[METAL_LOBE_ACROSS])
         + ramp_lobe(frame.z, ramp, 1 / (1 - further.energy));
}

// All bounces of a surface that the camera does not see, whose exact lobes matter less. A cosine
// lobe replaces the ramp, and the first bounce's closure carries the rest.
closure color unseen_conductor(Frame frame, Microsurface surface, Material material,
                               FurtherBounces further)
{
  // Divided by one facet's factor, because the first bounce's closure has it too.
  color kept = further.energy
               * (further.share * further.second
                  + (1 - further.share) * further.later * further.later * further.series);
  return whole_reflection(frame, surface, material,
                          1 + (1 - further.cosine) / (1 - further.energy) * kept)
         + (further.cosine * further.second * kept) * diffuse(frame.z);
}

// Nearly isotropic surfaces have the closures of both kinds, so that nothing jumps.
closure color fitted_conductor(Frame frame, Microsurface surface, Material material, vector wi,
                               Accuracy accuracy)
{
  int bounces = accuracy.max_bounces;
  if (!has_further_bounces(surface, material, wi, accuracy))
    return whole_reflection(frame, surface, material, 1);
  float anisotropic = min((1 - surface.alpha_y / surface.alpha_x) / LARGEST_BLENDED_ASPECT, 1);
  FresnelRange fresnel = fresnel_range(material.metal);
  closure color lobes = 0;
  if (anisotropic < 1) {
    FurtherBounces further = isotropic_further_bounces(surface, fresnel, wi, bounces);
    if (!is_seen())
      return unseen_conductor(frame, surface, material, further);
    lobes = seen_further_bounces(frame, surface, wi, further);
  }
  if (!surface.isotropic)
    lobes = (1 - anisotropic) * lobes
            + anisotropic * anisotropic_further_bounces(frame, surface, fresnel, wi, bounces);
  // This order spreads Cycles' samples most evenly over the closures, which gives the least noise.
  return lobes + whole_reflection(frame, surface, material, 1);
}

#endif
