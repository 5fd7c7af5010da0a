// WindowPicture.h - writes what the window shows to a file. Layer: apps.
// SPDX-License-Identifier: MIT
#pragma once

#include <osg/Camera>

#include <atomic>

namespace osgRayTrace::app
{

/// A final draw callback that writes its camera's viewport to osgraytrace-N.png, with all that is
/// drawn over the picture, once each time that somebody wants it.
class WindowPicture : public osg::Camera::DrawCallback
{
public:
    /// Asks for a file of the next frame. Any thread may call it.
    void want() { _wanted = true; }

    /// Writes the file if one is wanted. Called by the draw thread.
    void operator()(osg::RenderInfo& renderInfo) const override;

private:
    mutable std::atomic<bool> _wanted{false};
};

} // namespace osgRayTrace::app
