// FrameCapture.cpp - reads the viewport back from OpenGL. Layer: offscreen.
// SPDX-License-Identifier: MIT
#include <osgRayTrace/offscreen/FrameCapture>

#include <osg/RenderInfo>
#include <osg/Viewport>

namespace osgRayTrace
{

FrameCapture::FrameCapture() : _colorImage(new osg::Image), _depthImage(new osg::Image) {}

FrameCapture::~FrameCapture() = default;

void FrameCapture::operator()(osg::RenderInfo& renderInfo) const
{
    const osg::Camera* camera = renderInfo.getCurrentCamera();
    const osg::Viewport* viewport = camera ? camera->getViewport() : nullptr;
    if (!viewport) return;

    const int x = static_cast<int>(viewport->x());
    const int y = static_cast<int>(viewport->y());
    const int width = static_cast<int>(viewport->width());
    const int height = static_cast<int>(viewport->height());
    if (width < 1 || height < 1) return;
    _colorImage->readPixels(x, y, width, height, GL_RGBA, GL_UNSIGNED_BYTE);
    _depthImage->readPixels(x, y, width, height, GL_DEPTH_COMPONENT, GL_FLOAT);
}

} // namespace osgRayTrace
