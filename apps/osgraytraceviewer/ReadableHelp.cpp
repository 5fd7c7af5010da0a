// ReadableHelp.cpp - osgViewer's on-screen help on a dark plate. Layer: apps.
// SPDX-License-Identifier: MIT
#include "ReadableHelp.h"

#include <osg/Geode>
#include <osg/Geometry>
#include <osg/NodeVisitor>
#include <osgText/Text>

namespace osgRayTrace::app
{

namespace
{

/// Takes the outlines of texts.
class PlainTexts : public osg::NodeVisitor
{
public:
    PlainTexts() : osg::NodeVisitor(TRAVERSE_ALL_CHILDREN) {}

    void apply(osg::Drawable& drawable) override
    {
        auto* text = dynamic_cast<osgText::Text*>(&drawable);
        if (!text) return;
        text->setBackdropType(osgText::Text::NONE);
        text->setColor(osg::Vec4(1.0f, 1.0f, 1.0f, 1.0f));
    }
    using osg::NodeVisitor::apply;
};

/// Returns a dark plate behind all that the help's camera shows.
osg::ref_ptr<osg::Node> newPlate()
{
    // The camera's own unit is a pixel of a window of 1280 x 1024.
    osg::ref_ptr<osg::Geometry> plate =
        osg::createTexturedQuadGeometry({-1e4f, -1e4f, 0}, {2e4f, 0, 0}, {0, 2e4f, 0});
    osg::ref_ptr<osg::Vec4Array> color = new osg::Vec4Array(osg::Array::BIND_OVERALL);
    color->push_back(osg::Vec4(0.0f, 0.0f, 0.0f, 0.75f));
    plate->setColorArray(color);
    plate->getOrCreateStateSet()->setMode(GL_BLEND, osg::StateAttribute::ON);
    plate->getOrCreateStateSet()->setRenderBinDetails(-1, "RenderBin"); // before the texts
    osg::ref_ptr<osg::Geode> geode = new osg::Geode;
    geode->addDrawable(plate);
    return geode;
}

} // namespace

bool ReadableHelp::handle(const osgGA::GUIEventAdapter& event, osgGA::GUIActionAdapter& action)
{
    const bool handled = osgViewer::HelpHandler::handle(event, action);
    if (_readable || !handled || !_switch || _switch->getNumChildren() == 0) return handled;
    // osgViewer makes the texts as they are shown first.
    PlainTexts plain;
    _switch->accept(plain);
    _switch->addChild(newPlate(), true);
    _readable = true;
    return handled;
}

} // namespace osgRayTrace::app
