// SurfaceMap.h - the places of the surfaces of a view's pixels, for comparison with other views.
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

/// Holds a view's camera rays relative to a point near its eye, so that floats suffice. A point is
/// p = pole + E(x,y) + s D(x,y) with E = start + x startDx + y startDy and D alike. Starts are near
/// 0; the pole is in world space, in double.
struct PixelRays
{
    Vec3d pole{0.0};
    CameraRays rays;
    float footprint = 0.0f; ///< width of a pixel at s = 1, or anywhere if orthographic [length]
};

/// Returns nothing for a view without rays.
std::optional<PixelRays> pixelRays(const View& view);

/// Holds the surfaces that the pixels of a view show, in arrays by pixel with row 0 at the bottom;
/// see SurfaceBlock.
struct SurfaceMap
{
    View view; ///< view of the map; without size: the map is empty
    PixelRays rays;
    std::vector<float> normalX, normalY, normalZ;
    std::vector<float> along; ///< s of the surface; infinity: nothing is hit
    std::vector<float> lobe;
    std::vector<uint32_t> object; ///< 0: nothing is hit

    /// 1: the pixels to the left, right, above and below show the same surface.
    std::vector<uint8_t> smooth;
    std::vector<uint8_t> interior; ///< 1: the pixel and the eight around it are smooth
    bool finished = false;         ///< true: interior is known

    bool isOf(const View& other) const { return view.width > 0 && view == other; }
};

/// Begins an empty map for a view in the map's memory. Returns false and leaves the map without a
/// view if the view has no rays.
bool beginSurfaceMap(const View& view, SurfaceMap& map);

/// Sets the surfaces of the 4 x 4 pixels from (left, bottom) on. Any threads may set different
/// blocks at the same time.
void setBlock(int left, int bottom, const SurfaceBlock& block, SurfaceMap& map);

/// Finds the smooth pixels after all pixels are set; findInteriors then finds the interior ones.
void findSmooth(const Workers& workers, SurfaceMap& map);
void findInteriors(const Workers& workers, SurfaceMap& map);

/// Returns whether all of the 4 x 4 pixels are smooth.
bool isSmooth(const SurfaceMap& map, int left, int bottom);

/// Calls body(first row, row past the last) for all rows of an image, several rows at a time.
void forEachRows(const Workers& workers, int height,
                 const std::function<void(std::size_t, std::size_t)>& body);

/// Two pixels show different surfaces if a point of one is this far off the plane of the other
/// [pixel footprints], or if their normals differ by more than the angle of this cosine.
constexpr float kPlaneTolerance = 2.0f;
constexpr float kNormalCosine = 0.9f;

} // namespace osgRayTrace::engine
