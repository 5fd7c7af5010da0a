// ViewMasks.h - the traversal masks of the views that look at a scene. Layer: bridge.
// SPDX-License-Identifier: MIT
#pragma once

#include "osgRayTrace/bridge/common/ObjectIdentity.h"

#include <osg/FrameStamp>

#include <vector>

namespace osgRayTrace::engine
{

/// Holds the masks with which cameras have seen the scene last. The eyes of a camera may have a
/// mask each. A camera that draws no more is forgotten after passes of other cameras.
class ViewMasks
{
public:
    /// Records a pass of a camera; frameStamp may be null.
    void record(const ObjectName& camera, unsigned int mask, const osg::FrameStamp* frameStamp);

    /// Returns the masks in rising order, each once. frameStamp is that of the update that wants to
    /// know: the passes of an earlier frame are complete, and those of its own frame may not be.
    std::vector<unsigned int> inUse(const osg::FrameStamp* frameStamp) const;

    /// Number of passes of other cameras after which a camera is forgotten. Programs may make a
    /// camera for each picture, and a frame has fewer passes.
    static constexpr unsigned int kExpiry = 96;

private:
    struct View
    {
        ObjectName camera;
        bool stamped = false;            ///< whether the last pass had a frame number
        unsigned int frameNumber = 0;    ///< frame of the last pass
        unsigned int pass = 0;           ///< number of the last pass
        std::vector<unsigned int> masks; ///< masks of the last frame; without one, of the last pass
        std::vector<unsigned int> before; ///< masks of the frame before, if they may still hold
    };

    View& viewOf(const ObjectName& camera);
    void expire();

    std::vector<View> _views;
    unsigned int _pass = 0; ///< number of the last pass of any camera
};

} // namespace osgRayTrace::engine
