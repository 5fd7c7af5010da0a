// DisplayTexture.h - a picture with depth on the screen, all of OpenGL. Layer: public API, private.
// SPDX-License-Identifier: MIT
#pragma once

#include "osgRayTrace/film/ChangedTiles.h"
#include "osgRayTrace/session/view/DepthSlices.h"

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
/// gl_FragDepth. The objects belong to the one context that draws it. Storage here and in OpenGL is
/// kept while the size stays, for a picture of the view's size and for one of fewer pixels, which
/// may take turns; of a picture that changes in parts these alone are copied to OpenGL. Draw thread
/// of that context, unless stated otherwise.
class DisplayTexture
{
public:
    DisplayTexture();
    DisplayTexture(const DisplayTexture&) = delete;
    DisplayTexture& operator=(const DisplayTexture&) = delete;

    /// State that the drawable needs in its StateSet; what draw() sets beyond it is known to
    /// osg::State. Premultiplied blending, a solid unculled triangle, drawn after the opaque things
    /// of bin 0.
    static osg::ref_ptr<osg::StateSet> createStateSet();

    /// Makes room for width * height pixels; values are lost if that is a change. full: of the
    /// view's size.
    void resize(int width, int height, bool full);

    /// Once, memory for pictures of full size: the system takes long to hand it out, and the frame
    /// in which a view comes to rest has no time for that.
    void reserve(int width, int height);
    int width() const { return _shown->width; }
    int height() const { return _shown->height; }

    /// To be written to, then modified(). Row 0 at the bottom. Display values, 4 bytes a pixel:
    /// alpha is coverage, where it is 0 nothing is drawn; colours are multiplied with it. Window
    /// depths in [0,1].
    uint8_t* rgba() { return _shown->color->data(); }
    float* depth() { return reinterpret_cast<float*>(_shown->depth->data()); }
    void modified();
    void modified(const engine::ChangedTiles& tiles); ///< nothing but these

    /// Images of equal size, allocated as resize() does it, in place of those that there are.
    void show(osg::Image* color, osg::Image* depth);

    /// Fills the current viewport, whose size may be another: colours are smooth then, depths are
    /// not, as those between two things are of neither. Depths are as the map makes them. False,
    /// and nothing drawn, if the context has no usable GLSL.
    bool draw(osg::RenderInfo& renderInfo, const engine::DepthMap& depthMap);

    /// Any thread that OSG calls it from; null: all contexts.
    void releaseGLObjects(osg::State* state) const;
    void resizeGLObjectBuffers(unsigned int maxSize);

private:
    struct Picture
    {
        Picture();

        int width = 0;
        int height = 0;
        osg::ref_ptr<osg::Image> color;
        osg::ref_ptr<osg::Image> depth;
        osg::ref_ptr<osg::Texture2D> colorTexture;
        osg::ref_ptr<osg::Texture2D> depthTexture;
        engine::ChangedTiles changed; ///< since the textures were as the images
    };

    static void allocate(Picture& picture, int width, int height);
    bool useProgram(osg::State& state) const;
    void chooseFilter(const osg::State& state) const;
    void applyPicture(osg::State& state);

    Picture _full, _reduced;
    Picture* _shown = &_full;
    bool _hasDrawn = false;
    osg::ref_ptr<osg::Uniform> _colorUnit;
    osg::ref_ptr<osg::Uniform> _depthUnit;
    osg::ref_ptr<osg::Uniform> _depthMap;
    osg::ref_ptr<osg::Program> _program;     ///< GLSL 1.20
    osg::ref_ptr<osg::Program> _coreProgram; ///< GLSL 3.30, for contexts that take no older one
    osg::ref_ptr<osg::Geometry> _triangle;
};

} // namespace osgRayTrace
