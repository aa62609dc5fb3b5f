// SPDX-License-Identifier: GPL-3.0-or-later
// Places between the nodes of generated tables over alpha, the view's cosine and the index of
// refraction.
#ifndef MICROBOUNCE_TABLE3_H
#define MICROBOUNCE_TABLE3_H

#include "table.h"

// The six nodes around a place and their weights.
struct Cube {
  int node[6];
  float weight[6];
};

// The cell of a place. Nodes are even in the root of the index' logarithm, between `lowest` and
// `highest` and on either side of the surface; the other axes are table_cell's. `first` is added
// to the nodes' numbers.
Cube table_cube(float alpha, float cosine, float ior, float lowest, float highest, int alphas,
                int cosines, int indices, int first)
{
  float index = clamp(max(ior, 1 / ior), lowest, highest);
  float start = sqrt(log(lowest));
  float z = (sqrt(log(index)) - start) / (sqrt(log(highest)) - start) * (indices - 1);
  int k = clamp(int(z), 0, indices - 2);
  float r = z - k;
  int slice = alphas * cosines;
  Cell cell = table_cell(alpha, cosine, alphas, cosines, first + k * slice);
  Cube cube;
  for (int c = 0; c < 3; ++c) {
    cube.node[c] = cell.node[c];
    cube.node[c + 3] = cell.node[c] + slice;
    cube.weight[c] = (1 - r) * cell.weight[c];
    cube.weight[c + 3] = r * cell.weight[c];
  }
  return cube;
}

#endif
