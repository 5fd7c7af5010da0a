// MovedSamples.h - the samples of objects that have moved, taken along to their new places. Layer:
// session.
// SPDX-License-Identifier: MIT
#pragma once

#include "osgRayTrace/session/history/Reprojection.h"
#include "osgRayTrace/session/history/SceneChange.h"
#include "osgRayTrace/session/image/MapWindow.h"

#include <vector>

namespace osgRayTrace::engine
{

class RenderSession;

/// A pixel of an object that has moved takes no more samples along than this number.
constexpr float kMovedKept = 8.0f;

/// An object takes along the samples of no more steps than those in which it turned by this angle
/// altogether, or in which its way was this share of the distance to a light [radians].
constexpr float kMovedTurn = 0.1f;

/// Holds what the pixels of rigidly moved objects have accumulated, from before the scene changes
/// until the objects are seen at their new places. As seen from an object, the viewer has moved:
/// the samples are carried by reproject, in a window of the image around the object. They are of
/// light at the old place. Mirrors, and objects whose textures are not placed by vertices, take
/// nothing along.
class MovedSamples
{
public:
    /// Takes the samples of the image, which is of the view of map and of the scene before the
    /// change. lights: those of the scene, placed for the view. If the objects' windows are larger
    /// than the image altogether, the last objects take nothing along.
    void take(const SurfaceMap& map, const Scene& scene, const std::vector<Light>& lights,
              const SceneChange& change, const SampledImage& image, const Workers& workers);

    /// Returns the number of pixels whose samples were taken.
    std::size_t pixels() const;

    /// Sets the pixels of the image that have no samples and show one of the objects at its new
    /// place, in tiles of the session's image that have a pass. Returns the number of pixels that
    /// were set. What was taken is then gone.
    std::size_t carry(RenderSession& session, const Workers& workers, SampledImage& image);

private:
    struct Object
    {
        uint32_t object = 0; ///< as in a SurfaceMap
        ReprojectionLimits limits;
        Mat4d beforeFromAfter{1.0}; ///< world space
        PixelWindow oldWindow, newWindow;
        SurfaceMap map;     ///< the old window's
        SampledImage image; ///< the old window's
    };

    void chooseObjects(const SurfaceMap& map, const Scene& scene, const std::vector<Light>& lights,
                       const SceneChange& change);
    void findEdges(RenderSession& session, const Workers& workers) const;
    static std::size_t carryObject(const Object& object, RenderSession& session,
                                   const Workers& workers, SampledImage& image);

    std::vector<Object> _objects;
};

} // namespace osgRayTrace::engine
