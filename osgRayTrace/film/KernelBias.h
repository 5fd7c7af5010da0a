// KernelBias.h - how far look-ups of photons in discs blur the image. Layer: film.
// SPDX-License-Identifier: MIT
#pragma once

#include "osgRayTrace/base/Lanes.h"
#include "osgRayTrace/base/Math.h"

#include <vector>

namespace osgRayTrace::engine
{

/// The discs that are compared with that of a look-up have its radius over 2 and over 4.
constexpr int kComparedDiscs = 2;

/// The blocks of a tile that compare discs, one in each pair of passes: one of each row and column
/// of the tile's blocks, so that lines through the tile meet some of them.
constexpr int kComparedBlocks = 4;

/// Returns the block of the tile whose pixels compare discs in this pass.
int comparedBlock(int tile, int pass);

/// Holds sums over the passes of each half of the image, for the compared blocks of a tile: the
/// radiance by a disc less that by the next smaller one, of the same photons. Photons of different
/// passes are independent, so the product of the halves has no noise in the mean.
struct DiscDifferences
{
    Vec3 sums[kComparedBlocks][2][kComparedDiscs][kLanes] = {}; ///< by block, half, disc, lane

    /// Adds what the block of this pass has found.
    void add(int pass, const Vec3 (&differences)[kComparedDiscs][kLanes]);
};

/// Holds products of the two halves of a tile, summed over RGB: means over the pixels.
struct BiasProducts
{
    double same = 0.0; ///< of the differences between r and r / 2
    double next = 0.0; ///< of these and those between r / 2 and r / 4
    /// Variance of same if there is no bias and all pixels of a block have the same photons: half
    /// of the mean square of the difference between the halves, in which the bias cancels out, is
    /// the standard deviation of the product of a block.
    double variance = 0.0;
};

/// Returns the products after so many passes (two or more), each channel weighted.
BiasProducts biasProducts(const DiscDifferences& differences, int passes, const Vec3d& weights);

/// Returns an estimate of the sum over tiles of pixels[t] times the squared bias of tile t; 0 if
/// the products may be noise. If the bias is proportional to r^g, the difference d of two discs is
/// that to the next smaller ones times q = 2^-g, and the bias is d / (1 - q), the sum of the
/// geometric series of all smaller discs [Richardson11]. q is the ratio of the products, for the
/// whole image.
double squaredBias(const std::vector<BiasProducts>& tiles, const std::vector<double>& pixels);

/// Holds what the pixels of a tile know of the bias of their discs from the photons of their own
/// footprints, which have no bias: PathFootprints.cpp. Of luminance, summed over the pixels.
struct FootprintBias
{
    double squares = 0.0;  ///< squared bias of the mean of all passes; has no bias itself
    double variance = 0.0; ///< variance of squares if there is no bias

    /// Adds a pixel that has compared this many passes. sum: of the disc's luminance less that of
    /// the footprint; sumOfSquares: of the squares of these differences. biasedShare: of the
    /// image's passes, those whose discs have that bias, each by as much as the compared ones. The
    /// products of the differences of two passes have the squared bias as their mean:
    ///
    ///   E[sum^2 - sumOfSquares] = compared (compared - 1) bias^2
    void addPixel(int compared, double sum, double sumOfSquares, double biasedShare);
};

/// Returns the sum over tiles of scales[t] times the squared bias of tile t; 0 if it may be noise.
double squaredBias(const std::vector<FootprintBias>& tiles, const std::vector<double>& scales);

} // namespace osgRayTrace::engine
