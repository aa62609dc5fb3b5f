// SPDX-License-Identifier: GPL-3.0-or-later
// The reflectance of one microfacet.
#ifndef MICROBOUNCE_FRESNEL_H
#define MICROBOUNCE_FRESNEL_H

// Choices of the input Fresnel.
#define F82_TINT 0
#define N_AND_K 1

struct Conductor {
  int physical;  // has a complex index of refraction, else F82 tint
  color first;   // reflectance at normal incidence, or n
  color second;  // tint at 82 degrees, or k
};

// Schlick's curve with a dip at acos(1/7), where it is `tint` times Schlick's value (Kutz, Hasan
// and Edmondson 2021, "F82-tint").
color f82_tint_fresnel(color f0, color tint, float cosine)
{
  float s82 = 6.0 / 7.0;  // 1 - cosine at 82 degrees
  float s82_5 = s82 * s82 * s82 * s82 * s82;
  color dip = mix(f0, color(1), s82_5) * (1 - tint) * (7 / (s82 * s82_5));
  float s = 1 - cosine;
  float s5 = s * s * s * s * s;
  return clamp(mix(f0, color(1), s5) - dip * (cosine * s5 * s), color(0), color(1));
}

// Unpolarised reflectance of a conductor with index n + i k in vacuum (Born and Wolf, Principles
// of Optics, section 14.2). a^2 + b^2 and a come from the complex square root without
// cancellation: the smaller of (root +- real) / 2 follows from their product, (n k)^2.
color n_k_fresnel(color n, color k, float cosine)
{
  float cos2 = cosine * cosine;
  float sin2 = 1 - cos2;
  color real = n * n - k * k - sin2;
  color nk = n * k;
  color modulus = sqrt(real * real + 4 * nk * nk);
  color larger = 0.5 * (modulus + abs(real));
  color result;
  for (int i = 0; i < 3; ++i) {
    float smaller = (larger[i] > 0) ? nk[i] * nk[i] / larger[i] : 0;
    float a = sqrt((real[i] >= 0) ? larger[i] : smaller);
    float sum = modulus[i] + cos2;
    float cross_s = 2 * a * cosine;
    float rs = (sum + cross_s > 0) ? (sum - cross_s) / (sum + cross_s) : 1;
    float sum_p = modulus[i] * cos2 + sin2 * sin2;
    float cross_p = cross_s * sin2;
    float rp = (sum_p + cross_p > 0) ? rs * (sum_p - cross_p) / (sum_p + cross_p) : 1;
    result[i] = clamp(0.5 * (rs + rp), 0, 1);
  }
  return result;
}

// Reflectance for the cosine between the ray and the micronormal, in [0, 1].
color conductor_fresnel(Conductor metal, float cosine)
{
  return metal.physical ? n_k_fresnel(metal.first, metal.second, cosine)
                        : f82_tint_fresnel(metal.first, metal.second, cosine);
}

// Unpolarised reflectance of a dielectric. `eta` is the index beyond the facet over that on the
// path's side, and g = eta cos(theta_t). Fresnel's differences c - g and eta^2 c - g are
// multiplied out, which keeps their digits for eta near 1. g^2 = eta^2 - sin^2 = eta^2 - 1 + cos^2
// comes from the smaller square, which keeps its digits for eta near 0.
float dielectric_fresnel(float eta, float cosine)
{
  float rise = (eta - 1) * (eta + 1), eta2 = eta * eta;
  float sin2 = (1 - cosine) * (1 + cosine);
  float g2 = (cosine > 0.7) ? eta2 - sin2 : rise + cosine * cosine;
  if (g2 <= 0)
    return (rise == 0) ? 0 : 1;
  float g = sqrt(g2);
  float sum_s = cosine + g, sum_p = eta2 * cosine + g;
  float s = rise / (sum_s * sum_s);
  float p = rise * (eta2 * cosine * cosine - sin2) / (sum_p * sum_p);
  return min(0.5 * (s * s + p * p), 1);
}

#endif
