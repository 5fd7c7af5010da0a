// DisplayTexture.h - a picture with depth on the screen, all of OpenGL. Layer: public API, private.
// SPDX-License-Identifier: MIT
#pragma once

#include "osgRayTrace/bridge/DepthSlices.h"

#include <osg/Geometry>
#include <osg/Image>
#include <osg/Program>
#include <osg/RenderInfo>
#include <osg/StateSet>
#include <osg/Texture2D>
#include <osg/Uniform>

#include <cstdint>

namespace osgRayTrace
{

/// Colour and depth of one view, drawn as a triangle that covers the viewport and writes
/// gl_FragDepth. The objects belong to the one context that draws it; storage in OpenGL is kept
/// while the size stays. Draw thread of that context, unless stated otherwise.
class DisplayTexture
{
public:
    DisplayTexture();

    /// State that the drawable needs in its StateSet; what draw() sets beyond it is known to
    /// osg::State. Premultiplied blending, a solid unculled triangle, drawn after the opaque things
    /// of bin 0.
    static osg::ref_ptr<osg::StateSet> createStateSet();

    /// Makes room for width * height pixels; values are lost if that is a change.
    void resize(int width, int height);
    int width() const { return _width; }
    int height() const { return _height; }

    /// To be written to, then modified(). Row 0 at the bottom. Display values, 4 bytes a pixel:
    /// alpha is coverage, where it is 0 nothing is drawn; colours are multiplied with it. Window
    /// depths in [0,1].
    uint8_t* rgba() { return _color->data(); }
    float* depth() { return reinterpret_cast<float*>(_depth->data()); }
    void modified();

    /// Fills the current viewport, whose size may be another: colours are smooth then, depths are not, as those
    /// between two things are of neither. Depths are as the map makes them. False, and nothing drawn, if the
    /// context has no usable GLSL.
    bool draw(osg::RenderInfo& renderInfo, const engine::DepthMap& depthMap) const;

    /// Any thread that OSG calls it from; null: all contexts.
    void releaseGLObjects(osg::State* state) const;
    void resizeGLObjectBuffers(unsigned int maxSize);

private:
    bool useProgram(osg::State& state) const;
    void chooseFilter(const osg::State& state) const;

    int _width = 0;
    int _height = 0;
    osg::ref_ptr<osg::Image> _color;
    osg::ref_ptr<osg::Image> _depth;
    osg::ref_ptr<osg::Texture2D> _colorTexture;
    osg::ref_ptr<osg::Texture2D> _depthTexture;
    osg::ref_ptr<osg::Uniform> _colorUnit;
    osg::ref_ptr<osg::Uniform> _depthUnit;
    osg::ref_ptr<osg::Uniform> _depthMap;
    osg::ref_ptr<osg::Program> _program;     ///< GLSL 1.20
    osg::ref_ptr<osg::Program> _coreProgram; ///< GLSL 3.30, for contexts that take no older one
    osg::ref_ptr<osg::Geometry> _triangle;
};

} // namespace osgRayTrace
