// SPDX-License-Identifier: GPL-3.0-or-later
// Places between the nodes of generated tables over alpha and the view's cosine.
#ifndef MICROBOUNCE_TABLE_H
#define MICROBOUNCE_TABLE_H

// The three nodes around a place and their weights. They span half the square between four nodes.
struct Cell {
  int node[3];
  float weight[3];
};

// The cell of a place. Further bounces depend on cosine / alpha if both are small, and on the
// view's angle if that is small. So nodes are even in sqrt(alpha) and in sqrt(alpha (1 - cosine) /
// (alpha + cosine)). `first` is added to the nodes' numbers.
Cell table_cell(float alpha, float cosine, int alphas, int cosines, int first)
{
  float x = sqrt(alpha) * (alphas - 1);
  float y = sqrt(alpha * (1 - cosine) / (alpha + cosine)) * (cosines - 1);
  int i = min(int(x), alphas - 2), j = min(int(y), cosines - 2);
  float s = x - i, t = y - j;
  Cell cell;
  cell.node[0] = first + i * cosines + j;
  cell.node[1] = cell.node[0] + ((s > t) ? cosines : 1);
  cell.node[2] = cell.node[0] + cosines + 1;
  cell.weight[0] = 1 - max(s, t);
  cell.weight[1] = abs(s - t);
  cell.weight[2] = min(s, t);
  return cell;
}

#endif
