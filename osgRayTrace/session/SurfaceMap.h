// SurfaceMap.h - where the surfaces of a view's pixels are, as pixels of another view ask for it.
// Layer: session. SPDX-License-Identifier: MIT
#pragma once

#include "osgRayTrace/scene/View.h"
#include "osgRayTrace/session/ShownImage.h"

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

/// Arrays by pixel, row 0 at the bottom.
struct SurfaceMap
{
    View view;
    PixelRays rays;
    std::vector<float> normalX, normalY, normalZ;
    std::vector<float> along;     ///< s of the hit; infinity: nothing is hit
    std::vector<float> lobe;      ///< SurfaceSample::lobe
    std::vector<uint32_t> object; ///< 0: nothing is hit
    std::vector<uint8_t>
        smooth; ///< 1: the pixels to the left, right, above and below show the same surface
    std::vector<uint8_t> interior; ///< 1: smooth, and so are the eight pixels around
};

/// samples: of this view, one for each pixel. False, and the map is not changed, if the view has no
/// rays or there are not as many samples as it has pixels. Reuses the map's memory.
bool makeSurfaceMap(const View& view, const std::vector<SurfaceSample>& samples,
                    const Workers& workers, SurfaceMap& map);

/// body(first row, row past the last) for all rows of an image, some of them at a time.
void forEachRows(const Workers& workers, int height,
                 const std::function<void(std::size_t, std::size_t)>& body);

/// A surface is another one where a point of it is this far off its plane [pixel footprints], or
/// its normal turned by more than the angle of this cosine.
constexpr float kPlaneTolerance = 2.0f;
constexpr float kNormalCosine = 0.9f;

} // namespace osgRayTrace::engine
