// MovedSamples.h - the samples of objects that have moved, taken along to their new places. Layer:
// session.
// SPDX-License-Identifier: MIT
#pragma once

#include "osgRayTrace/session/history/LampPlaces.h"
#include "osgRayTrace/session/history/Reprojection.h"
#include "osgRayTrace/session/history/SceneChange.h"
#include "osgRayTrace/session/image/MapWindow.h"

#include <cstdint>
#include <vector>

namespace osgRayTrace::engine
{

class RenderSession;

/// A pixel of an object that has moved takes no more samples along than this number.
constexpr float kMovedKept = 8.0f;

/// The light on an object changes as the object turns or moves past a light. For each step the
/// angle of the turn [radians] and the length of the way, as a share of the distance to the nearest
/// light, are added up. An object takes along samples of its last steps only: those whose sums are
/// altogether no more than this number.
constexpr float kMovedTurn = 0.1f;

/// Holds what the pixels of rigidly moved objects have accumulated, from before the scene changes
/// until the objects are seen at their new places. In the coordinates of a moved object the object
/// rests and the viewer has moved, so that reproject carries the samples, in a window of the image
/// around the object. The samples keep the light of the object's old place. Mirrors, and objects
/// whose textures are not placed by vertices, take no samples along.
class MovedSamples
{
public:
    /// Takes the samples of the image, which is of the view of map and of the scene before the
    /// change. lights: those of the scene, placed for the view. If the objects' windows are larger
    /// than the image altogether, the last objects take nothing along.
    void take(const SurfaceMap& map, const Scene& scene, const std::vector<Light>& lights,
              const SceneChange& change, const SampledImage& image, const Workers& workers);

    /// Returns the largest number of pixels that carry() may set.
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
    LampPlaces _lamps;
};

} // namespace osgRayTrace::engine
