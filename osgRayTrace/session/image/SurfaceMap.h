// SurfaceMap.h - where the surfaces of a view's pixels are, as pixels of another view ask for it.
// Layer: session.
// SPDX-License-Identifier: MIT
#pragma once

#include "osgRayTrace/integrators/shared/Integrator.h"
#include "osgRayTrace/scene/View.h"

#include <cstdint>
#include <functional>
#include <optional>
#include <vector>

namespace osgRayTrace::engine
{

class Workers;

/// A view's camera rays relative to a point near its eye, so that floats do: p = pole + E(x,y) + s
/// D(x,y) with E = start + x startDx + y startDy and D alike. Starts are near 0; pole is in the
/// world, in double.
struct PixelRays
{
    Vec3d pole{0.0};
    CameraRays rays;
    float footprint = 0.0f; ///< width of a pixel at s = 1, or anywhere if orthographic [length]
};

/// Nothing for a view without rays.
std::optional<PixelRays> pixelRays(const View& view);

/// What the pixels of a view show. Arrays by pixel, row 0 at the bottom; see SurfaceBlock.
struct SurfaceMap
{
    View view; ///< of no size: the map is of nothing
    PixelRays rays;
    std::vector<float> normalX, normalY, normalZ;
    std::vector<float> along; ///< s of the surface; infinity: nothing is hit
    std::vector<float> lobe;
    std::vector<uint32_t> object; ///< 0: nothing is hit

    std::vector<uint8_t>
        smooth; ///< 1: the pixels to the left, right, above and below show the same surface
    std::vector<uint8_t> interior; ///< 1: smooth, and so are the eight pixels around
    bool finished = false;         ///< interior is known

    bool isOf(const View& other) const { return view.width > 0 && view == other; }
};

/// An empty map for a view, in the map's memory. False, and the map is of nothing, if it has no
/// rays.
bool beginSurfaceMap(const View& view, SurfaceMap& map);

/// What the 4 x 4 pixels from one on show. Different ones by any threads.
void setBlock(int left, int bottom, const SurfaceBlock& block, SurfaceMap& map);

/// After all pixels are set: which of them are smooth; and then, which are interior.
void findSmooth(const Workers& workers, SurfaceMap& map);
void findInteriors(const Workers& workers, SurfaceMap& map);

/// True if all of the 4 x 4 pixels are.
bool isSmooth(const SurfaceMap& map, int left, int bottom);

/// body(first row, row past the last) for all rows of an image, some of them at a time.
void forEachRows(const Workers& workers, int height,
                 const std::function<void(std::size_t, std::size_t)>& body);

/// A surface is another one where a point of it is this far off its plane [pixel footprints], or
/// its normal turned by more than the angle of this cosine.
constexpr float kPlaneTolerance = 2.0f;
constexpr float kNormalCosine = 0.9f;

} // namespace osgRayTrace::engine
