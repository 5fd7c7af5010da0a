// Overlay.cpp - text over the picture, in pixels of the window. Layer: apps.
// SPDX-License-Identifier: MIT
#include "Overlay.h"

#include <osg/Geode>
#include <osg/Viewport>
#include <osgViewer/View>

namespace osgRayTrace::app
{

namespace
{

constexpr float kPlateMargin = 5.0f; // pixels

} // namespace

osg::ref_ptr<osgText::Text> newOverlayText()
{
    osg::ref_ptr<osgText::Text> text = new osgText::Text;
    text->setDataVariance(osg::Object::DYNAMIC);
    text->setCharacterSize(kOverlayCharacter);
    text->setPosition(osg::Vec3(kOverlayMargin, kOverlayMargin, 0.0f));
    // The plate is dark: outlines would close over decimal points.
    text->setDrawMode(osgText::Text::TEXT | osgText::Text::FILLEDBOUNDINGBOX);
    text->setBoundingBoxColor(osg::Vec4(0.0f, 0.0f, 0.0f, 0.75f));
    text->setBoundingBoxMargin(kPlateMargin);
    return text;
}

osg::ref_ptr<osg::Camera> newOverlay(osg::Drawable* drawable)
{
    osg::ref_ptr<osg::Camera> camera = new osg::Camera;
    camera->setReferenceFrame(osg::Transform::ABSOLUTE_RF);
    camera->setRenderOrder(osg::Camera::POST_RENDER);
    camera->setClearMask(0);
    camera->setAllowEventFocus(false);
    camera->setProjectionMatrixAsOrtho2D(0.0, 1280.0, 0.0, 1024.0);
    osg::StateSet* stateSet = camera->getOrCreateStateSet();
    const auto off = osg::StateAttribute::OFF | osg::StateAttribute::PROTECTED;
    stateSet->setMode(GL_LIGHTING, off);
    stateSet->setMode(GL_DEPTH_TEST, off);
    osg::ref_ptr<osg::Geode> geode = new osg::Geode;
    geode->addDrawable(drawable);
    camera->addChild(geode.get());
    return camera;
}

double fitOverlay(osg::Camera& overlay, osgGA::GUIActionAdapter& action, double height)
{
    const auto* view = dynamic_cast<osgViewer::View*>(&action);
    const osg::Viewport* viewport = view ? view->getCamera()->getViewport() : nullptr;
    if (!viewport) return height;
    overlay.setProjectionMatrixAsOrtho2D(0.0, viewport->width(), 0.0, viewport->height());
    return viewport->height();
}

} // namespace osgRayTrace::app
