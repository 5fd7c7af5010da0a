// WindowPicture.cpp - reads the window back. Layer: apps.
// SPDX-License-Identifier: MIT
#include "WindowPicture.h"

#include "FreeName.h"

#include "apps/common/Failure.h"
#include "apps/common/ImageFile.h"

#include <osg/Notify>
#include <osg/RenderInfo>
#include <osg/Viewport>

namespace osgRayTrace::app
{

void WindowPicture::operator()(osg::RenderInfo& renderInfo) const
{
    const osg::Camera* camera = renderInfo.getCurrentCamera();
    const osg::Viewport* viewport = camera ? camera->getViewport() : nullptr;
    if (!viewport || !_wanted.exchange(false)) return;
    const osg::ref_ptr<osg::Image> image = new osg::Image;
    image->readPixels(static_cast<int>(viewport->x()), static_cast<int>(viewport->y()),
                      static_cast<int>(viewport->width()), static_cast<int>(viewport->height()),
                      GL_RGBA, GL_UNSIGNED_BYTE);
    const std::string name = freeName(".png");
    try
    {
        writeImageFile(name, *image);
        OSG_NOTICE << "osgraytraceviewer: wrote " << name << std::endl;
    }
    catch (const Failure& failure)
    {
        OSG_WARN << "osgraytraceviewer: " << failure.what() << std::endl;
    }
}

} // namespace osgRayTrace::app
