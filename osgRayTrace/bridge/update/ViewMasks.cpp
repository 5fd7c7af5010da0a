// ViewMasks.cpp - keeps the traversal masks of the views of a scene. Layer: bridge.
// SPDX-License-Identifier: MIT
#include "osgRayTrace/bridge/update/ViewMasks.h"

#include <algorithm>

namespace osgRayTrace::engine
{

namespace
{

bool contains(const std::vector<unsigned int>& masks, unsigned int mask)
{
    return std::find(masks.begin(), masks.end(), mask) != masks.end();
}

void add(std::vector<unsigned int>& masks, const std::vector<unsigned int>& more)
{
    for (const unsigned int mask : more)
        if (!contains(masks, mask)) masks.push_back(mask);
}

} // namespace

/// Returns the entry of a camera, which may be new.
ViewMasks::View& ViewMasks::viewOf(const ObjectName& camera)
{
    for (View& view : _views)
        if (view.camera == camera) return view;
    _views.emplace_back().camera = camera;
    return _views.back();
}

void ViewMasks::record(const ObjectName& camera, unsigned int mask,
                       const osg::FrameStamp* frameStamp)
{
    View& view = viewOf(camera);
    const unsigned int frameNumber = frameStamp ? frameStamp->getFrameNumber() : 0;
    if (!frameStamp || !view.stamped || view.frameNumber != frameNumber)
    {
        view.before.swap(view.masks);
        view.masks.clear();
    }
    view.stamped = frameStamp != nullptr;
    view.frameNumber = frameNumber;
    view.pass = ++_pass;
    // A mask that the frame before did not have replaces those that it had. Without frames the pass
    // before may be that of another eye.
    if (view.stamped && !contains(view.before, mask)) view.before.clear();
    if (!contains(view.masks, mask)) view.masks.push_back(mask);
    expire();
}

void ViewMasks::expire()
{
    const auto old = [this](const View& view) { return _pass - view.pass > kExpiry; };
    _views.erase(std::remove_if(_views.begin(), _views.end(), old), _views.end());
}

std::vector<unsigned int> ViewMasks::inUse(const osg::FrameStamp* frameStamp) const
{
    std::vector<unsigned int> masks;
    for (const View& view : _views)
    {
        add(masks, view.masks);
        const bool complete =
            frameStamp && view.stamped && view.frameNumber != frameStamp->getFrameNumber();
        if (!complete) add(masks, view.before);
    }
    std::sort(masks.begin(), masks.end());
    return masks;
}

} // namespace osgRayTrace::engine
