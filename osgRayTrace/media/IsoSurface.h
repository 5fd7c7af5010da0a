// IsoSurface.h - the surface on which a volume has a value, as triangles. Layer: media.
// SPDX-License-Identifier: MIT
#pragma once

#include "osgRayTrace/scene/Volume.h"

#include <array>
#include <cstdint>
#include <optional>
#include <vector>

namespace osgRayTrace::engine
{

/// The triangles of a cell of eight corners, for one set of corners that are inside. Corner x + 2 y
/// + 4 z is at (x, y, z). Edges 0 to 3 are along x, at y + 2 z; 4 to 7 along y, at 4 + x + 2 z; 8
/// to 11 along z, at 8 + x + 2 y.
struct IsoCell
{
    int triangles = 0;
    std::array<uint8_t, 30> edges{}; ///< three a triangle, counter-clockwise from outside
};

/// Returns the triangles of a cell by the bits of its corners that are inside. Corners that are
/// inside and meet in a face by a diagonal alone are parted, in both cells of the face: surfaces of
/// cells that lie side by side have no gaps.
const IsoCell& isoCell(unsigned int inside);

/// Holds a mesh in the unit cube of an image. It is closed: each edge has a triangle at both sides.
struct IsoSurface
{
    std::vector<Vec3> positions;
    std::vector<Vec3> normals;    ///< down the gradient, of any length; 0: there is no gradient
    std::vector<UVec3> triangles; ///< counter-clockwise, seen from where values are lower
};

/// Returns the surface around what has a value above the given one; below it if it is negative.
/// [Lorensen87] on the lattice of the middles of voxels, with values of 0 beyond the image. Flat
/// faces close it where the image or the unit cube of tileFromImage ends. Takes memory for two
/// slices of flags beside the result. Nothing: there would be more than mostTriangles.
std::optional<IsoSurface> isoSurface(const VolumeImage& image, float value,
                                     const Affine& tileFromImage, std::size_t mostTriangles);

} // namespace osgRayTrace::engine
