// GraphEditor.h - random edits of a scene graph that replace objects by others of the same size.
// Layer: tests.
// SPDX-License-Identifier: MIT
#pragma once

#include <osg/Geometry>
#include <osg/Group>
#include <osg/Image>
#include <osg/StateSet>

#include <cstdint>
#include <random>

namespace osgRayTrace::test
{

/// Each edit is one that an application makes between frames. What is replaced is released before
/// its replacement is created, so that malloc gives the new object the address of the old one:
/// whoever takes an address for an identity sees no difference, or reads one class as another.
class GraphEditor
{
public:
    /// Builds a small scene below root: objects, a switch, a level of detail and a lamp.
    GraphEditor(osg::Group& root, uint32_t seed);

    void edit();

    /// Returns the kind of the last edit, for messages.
    int last() const { return _last; }

    static constexpr int kKinds = 22;

private:
    using NodeMaker = osg::ref_ptr<osg::Node> (GraphEditor::*)();

    unsigned int number(unsigned int count) { return static_cast<unsigned int>(_random()) % count; }
    double real() { return double(_random()) / 4294967296.0; }
    float shade() { return float(real()); }

    osg::ref_ptr<osg::Array> newCoordinates();
    osg::ref_ptr<osg::Vec3Array> newPositions();
    osg::ref_ptr<osg::PrimitiveSet> newTriangles();
    osg::ref_ptr<osg::Array> newColors();
    osg::ref_ptr<osg::Node> newGeometry();
    osg::ref_ptr<osg::Image> newImage();
    osg::ref_ptr<osg::StateAttribute> newTexture();
    osg::ref_ptr<osg::StateSet> newState();
    osg::ref_ptr<osg::Node> newObject();
    osg::ref_ptr<osg::Node> newLamp();

    osg::Group& anyGroup();
    osg::Group& anyObject();
    osg::Geometry* anyGeometry();
    void replaceChild(osg::Group& group, unsigned int child, NodeMaker make);
    void place(osg::Node& node);
    void paint(osg::Image& image);
    void setHint(osg::Node& node);

    osg::ref_ptr<osg::Group> _objects, _lamps, _switch, _levels;
    std::mt19937 _random;
    int _last = -1;
};

} // namespace osgRayTrace::test
