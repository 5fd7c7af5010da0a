// MissingContext.cpp - stands for a kind of context that was not built. Layer: offscreen.
// SPDX-License-Identifier: MIT
#include <osgRayTrace/offscreen/OffscreenContext>

#include <osg/Notify>

namespace osgRayTrace
{

#ifndef OSGRAYTRACE_HAVE_OSMESA
osg::ref_ptr<osg::GraphicsContext> createOSMesaContext(int, int, osg::GraphicsContext*)
{
    OSG_WARN << "osgRayTrace: no OSMesaContext: built without OSMesa" << std::endl;
    return nullptr;
}
#endif

#ifndef OSGRAYTRACE_HAVE_EGL
osg::ref_ptr<osg::GraphicsContext> createEGLContext(int, int, osg::GraphicsContext*)
{
    OSG_WARN << "osgRayTrace: no EGLContext: built without EGL" << std::endl;
    return nullptr;
}
#endif

} // namespace osgRayTrace
